#!/usr/bin/env python3
"""Houses of ever more rooms, of which the eye sees one: what the rooms that it doesn't see cost.

usage: bench/building.py [--keyhole build/keyhole] [--rooms 3,9,27,81] [--times 10,40] [--methods path,ipm,mps,auto]
                         [--resolution 320x240] [--reference-seconds 240] [-j 2] [--out building] [--at-most 2]

Each house has N x N rooms of 4 x 3 m with a table, a chair and a cupboard, open doorways to all neighbours, and a lamp under every
ceiling but that of the room in the middle, where the eye is. The picture is hardly another one with more rooms, and so its error at
equal CPU time shouldn't be. Errors are trimmed squared relative ones free of the noise of two references (`keyhole diff`,
cross_trim), long renders by `ipm`, which stay in OUT. Time counts from when the scene has been read. The last columns are the error
over that of the smallest house. With --at-most the status is 1 if that is more anywhere, `path` apart.
"""
import argparse
import concurrent.futures
import os
import pathlib
import sys

from common import diff, render_for

ROOT = pathlib.Path(__file__).resolve().parent.parent
WIDTH, DEPTH, HEIGHT, DOOR, LINTEL = 4.0, 3.0, 2.6, 0.8, 2.0
HEAD = """film: {{resolution: [320, 240]}}
camera: {{from: [{0}, 1.55, {1}], to: [{2}, 0.9, {3}], fov: 68}}
materials:
  plaster: {{type: diffuse, reflectance: [0.74, 0.71, 0.66]}}
  paint: {{type: diffuse, reflectance: [0.35, 0.5, 0.55]}}
  floor: {{type: diffuse, reflectance: [0.45, 0.33, 0.22]}}
  wood: {{type: diffuse, reflectance: [0.55, 0.38, 0.22]}}
  cloth: {{type: diffuse, reflectance: [0.6, 0.2, 0.15]}}
  lamp: {{type: diffuse, reflectance: 0}}
shapes:
"""


def wall(x, z, along_x, door, material):
    """A wall of a room from (x, z), with a doorway in its middle."""
    length = WIDTH if along_x else DEPTH
    step = (lambda t: [t, 0, 0]) if along_x else (lambda t: [0, 0, t])
    at = (lambda t, y: [x + t, y, z]) if along_x else (lambda t, y: [x, y, z + t])
    parts = [(0, 0, length, HEIGHT)]
    if door:
        side = (length - DOOR) / 2
        parts = [(0, 0, side, HEIGHT), (side + DOOR, 0, side, HEIGHT), (side, LINTEL, DOOR, HEIGHT - LINTEL)]
    return [f"  - {{type: rectangle, corner: {at(t, y)}, u: {step(w)}, v: [0, {h}, 0], material: {material}}}"
            for t, y, w, h in parts]


def furniture(x, z):
    boxes = [((0.9, 0.7, 0.5), (2.1, 0.74, 1.1), "wood"), ((0.95, 0, 0.55), (1.0, 0.7, 1.05), "wood"),
             ((2.0, 0, 0.55), (2.05, 0.7, 1.05), "wood"), ((1.3, 0.42, 1.2), (1.7, 0.46, 1.6), "cloth"),
             ((1.32, 0, 1.22), (1.68, 0.42, 1.58), "wood"), ((1.3, 0.46, 1.56), (1.7, 0.9, 1.6), "cloth"),
             ((3.4, 0, 2.2), (3.9, 1.7, 2.9), "wood")]
    return [f"  - {{type: box, min: {[x + a[0], a[1], z + a[2]]}, max: {[x + b[0], b[1], z + b[2]]}, material: {m}}}"
            for a, b, m in boxes]


def house(n, path):
    size_x, size_z, middle = n * WIDTH, n * DEPTH, n // 2
    lines = [f"  - {{type: rectangle, corner: [0, 0, 0], u: [0, 0, {size_z}], v: [{size_x}, 0, 0], material: floor}}",
             f"  - {{type: rectangle, corner: [0, {HEIGHT}, 0], u: [{size_x}, 0, 0], v: [0, 0, {size_z}], material: plaster}}"]
    for i in range(n + 1):
        for k in range(n):
            material = "paint" if i % 2 else "plaster"
            lines += wall(i * WIDTH, k * DEPTH, False, 0 < i < n, material)
            lines += wall(k * WIDTH, i * DEPTH, True, 0 < i < n, material)
    for i in range(n):
        for k in range(n):
            x, z = i * WIDTH, k * DEPTH
            lines += furniture(x, z)
            if (i, k) != (middle, middle):
                lines.append(f"  - {{type: rectangle, corner: [{x + 1.8}, {HEIGHT - 0.02}, {z + 1.3}], u: [0.4, 0, 0], "
                             f"v: [0, 0, 0.4], material: lamp, emission: {{power: 60}}}}")
    x, z = middle * WIDTH, middle * DEPTH
    path.write_text(HEAD.format(x + 0.25, z + 2.8, x + 2.6, z + 0.9) + "\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=str(ROOT / "build/keyhole"))
    parser.add_argument("--rooms", default="3,9,27,81")
    parser.add_argument("--times", default="10,40")
    parser.add_argument("--methods", default="path,ipm,mps,auto")
    parser.add_argument("--resolution", default="320x240")
    parser.add_argument("--reference-seconds", type=float, default=240)
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--out", default="building")
    parser.add_argument("--at-most", type=float, default=float("inf"))
    args = parser.parse_args()
    out = pathlib.Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    rooms, times, methods = [int(n) for n in args.rooms.split(",")], [float(t) for t in args.times.split(",")], args.methods.split(",")
    references = {n: [out / f"{n}.{x}.exr" for x in "ab"] for n in rooms}
    errors = {}

    def render(n, picture, method, seconds, seed):
        render_for(args.keyhole, out / f"{n}.yaml", seconds, method, seed, args.resolution, picture)

    def measure(n, seconds, method):
        picture = out / f"{n}-{seconds:g}-{method}.exr"
        render(n, picture, method, seconds, 1)
        errors[n, seconds, method] = diff(args.keyhole, picture, *references[n])["cross_trim"]

    for n in rooms:
        house(n, out / f"{n}.yaml")
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        missing = [(n, path, 101 + i) for n in rooms for i, path in enumerate(references[n]) if not path.exists()]
        list(pool.map(lambda m: render(m[0], m[1], "ipm", args.reference_seconds, m[2]), missing))
        list(pool.map(lambda m: measure(*m), [(n, s, m) for s in times for n in rooms for m in methods]))

    print("| s | method | " + " | ".join(f"{n * n} rooms" for n in rooms) + " | " + " | ".join(f"{n * n} over" for n in rooms[1:]) + " |")
    print("| --- " * (1 + 2 * len(rooms) + 1) + "|")
    worst = 0
    for seconds in times:
        for method in methods:
            row = [errors[n, seconds, method] for n in rooms]
            ratios = [e / row[0] for e in row[1:]]
            worst = max([worst, *ratios]) if method != "path" else worst
            print(f"| {seconds:g} | {method} | " + " | ".join(f"{e:.2g}" for e in row) + " | " + " | ".join(f"{r:.2f}" for r in ratios) + " |")
    return 1 if worst > args.at_most else 0


if __name__ == "__main__":
    sys.exit(main())
