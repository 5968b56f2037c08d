#!/usr/bin/env python3
"""Two rooms and an ever narrower door: the error of each sampler at equal CPU time, with user paths, with openings that it finds, and without.

usage: bench/door_sweep.py [--keyhole build/keyhole] [--widths 0.3,0.1,...] [--seconds 5] [--repeats 2] [--reference-seconds 40] [--figure doors.svg]

The lamp stands behind a screen in one room, the eye looks at the far wall of the other, so that all light in the picture has come
through the door after a scattering or more. Without doors to compare with, the references are two independent long renders by mlt
with user paths; their difference is printed beside the errors, which are free of it: root of the mean of (A - R1)(A - R2) / R^2 over 4x4
blocks of pixels. The brightness over the width of the door tends to a constant: a method that misses light shows there.
Needs numpy and OpenImageIO for Python."""
import argparse
import json
import pathlib
import subprocess

import numpy

from common import luminance

GUIDED = ["--user-paths", "USER_PATHS"]
NOT_LOOKING = ["-D", "find_openings=false"]
METHODS = {"pm": [], "ipm, not looking": NOT_LOOKING, "mps, not looking": NOT_LOOKING, "auto, not looking": NOT_LOOKING,
           "ipm": [], "mps": [], "auto": [],
           "ipm, user paths": GUIDED, "mps, user paths": GUIDED, "auto, user paths": GUIDED, "mlt, user paths": GUIDED}
SCENE = """film: {{resolution: [64, 48]}}
camera: {{from: [0.4, 1.2, -1.2], to: [3, 1, 0.3], fov: 60}}
materials:
  white: {{type: diffuse, reflectance: 0.7}}
  black: {{type: diffuse, reflectance: 0}}
shapes:
  - {{type: rectangle, material: white, corner: [-3, 0, -1.5], u: [0, 0, 3], v: [6, 0, 0]}}    # floor
  - {{type: rectangle, material: white, corner: [-3, 2.4, -1.5], u: [6, 0, 0], v: [0, 0, 3]}}  # ceiling
  - {{type: rectangle, material: white, corner: [-3, 0, -1.5], u: [6, 0, 0], v: [0, 2.4, 0]}}
  - {{type: rectangle, material: white, corner: [-3, 0, 1.5], u: [0, 2.4, 0], v: [6, 0, 0]}}
  - {{type: rectangle, material: white, corner: [-3, 0, -1.5], u: [0, 2.4, 0], v: [0, 0, 3]}}
  - {{type: rectangle, material: white, corner: [3, 0, -1.5], u: [0, 0, 3], v: [0, 2.4, 0]}}
  - {{type: rectangle, material: white, corner: [0, 0, -1.5], u: [0, 2.4, 0], v: [0, 0, {side}]}}   # the wall, and a door in it
  - {{type: rectangle, material: white, corner: [0, 0, {half}], u: [0, 2.4, 0], v: [0, 0, {side}]}}
  - {{type: rectangle, material: white, corner: [-1.5, 0, 0.4], u: [0, 2.4, 0], v: [0, 0, 1.1]}}    # the screen
  - {{type: rectangle, material: black, corner: [-2.7, 2.39, 0.9], u: [0.4, 0, 0], v: [0, 0, 0.4], emission: {{power: 100}}}}
"""
# Any way from the lamp to the door.
PATHS = """tolerance: 0.1
paths:
  - name: door
    points:
      - [-2.5, 2.39, 1.1]
      - bounces: [1, 22]
      - through: {{corner: [0, 0, -{half}], u: [0, 2.4, 0], v: [0, 0, {width}]}}
      - [3, 1, 0]
"""


class Bench:
    def __init__(self, arguments):
        self.arguments = arguments
        self.work = pathlib.Path(arguments.work)
        self.work.mkdir(parents=True, exist_ok=True)

    def write(self, width):
        self.scene, self.paths = self.work / f"door_{width}.yaml", self.work / f"paths_{width}.yaml"
        self.scene.write_text(SCENE.format(half=width / 2, side=1.5 - width / 2))
        self.paths.write_text(PATHS.format(half=width / 2, width=width))

    def render(self, name, seed, seconds):
        out, stats = self.work / "picture.exr", self.work / "stats.json"
        extra = [str(self.paths) if a == "USER_PATHS" else a for a in METHODS[name]]
        subprocess.run([self.arguments.keyhole, "render", self.scene, "--method", name.split(",")[0], "-q", "-t", "1", "--no-png",
                        "-o", out, "--stats", stats, "--cpu-time", str(seconds), "--seed", str(seed), *extra],
                       check=True, stderr=subprocess.DEVNULL)
        return blocks(out), json.loads(stats.read_text())


def blocks(path):
    y = luminance(path)
    return y.reshape(y.shape[0] // 4, 4, y.shape[1] // 4, 4).mean((1, 3))


def root_mean(values):
    return numpy.sqrt(max(0.0, float(values.mean())))


def draw(errors, path):
    """A line for each method that was measured: error over the width of the door."""
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "doors", "font.size": 9})
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(6, 3.4))
    for (name, points), marker in zip(errors.items(), "osv^D*xP+<>h"):
        axes.loglog(*zip(*points), marker=marker, label=name)
    axes.set_xlabel("width of the door [m]")
    axes.set_ylabel("relative error")
    axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default="build/keyhole")
    parser.add_argument("--widths", default="0.3,0.1,0.03,0.01,0.003,0.001")
    parser.add_argument("--methods", default="; ".join(METHODS))
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--repeats", type=int, default=2)
    parser.add_argument("--reference-seconds", type=float, default=40)
    parser.add_argument("--work", default="door-sweep")
    parser.add_argument("--figure", help="SVG to draw errors in; needs matplotlib")
    errors = {}
    bench = Bench(parser.parse_args())
    print("| door [m] | method | error | brightness / width | photons | KiB | error x sqrt(KiB) | used |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for width in map(float, bench.arguments.widths.split(",")):
        bench.write(width)
        halves = [bench.render("mlt, user paths", seed, bench.arguments.reference_seconds)[0] for seed in (1001, 1002)]
        mean = (halves[0] + halves[1]) / 2
        print(f"| {width:g} | reference | {root_mean(((halves[0] - halves[1]) / 2 / mean) ** 2):.3f} | {mean.mean() / width:.3g} | | | | |",
              flush=True)
        for name in bench.arguments.methods.split("; "):
            squares, bright, stats = [], [], {}
            for seed in range(1, bench.arguments.repeats + 1):
                picture, stats = bench.render(name, seed, bench.arguments.seconds)
                squares.append((picture - halves[0]) * (picture - halves[1]) / mean ** 2)
                bright.append(picture.mean() / width)
            e, kib = root_mean(numpy.array(squares)), stats["photon_bytes"] / 1024
            errors.setdefault(name, []).append((width, e))
            print(f"| {width:g} | {name} | {e:.3f} | {numpy.mean(bright):.3g} | {stats['photons_global'] + stats['photons_caustic']} | {kib:.0f} | "
                  f"{e * kib ** 0.5:.2f} | {stats['method']} |", flush=True)
    if bench.arguments.figure:
        draw(errors, bench.arguments.figure)


if __name__ == "__main__":
    main()
