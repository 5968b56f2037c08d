#!/usr/bin/env python3
"""How the error falls with passes at a fixed memory: relative MSE against the number of passes, and its slope in logarithms.

usage: bench/passes_slope.py [--keyhole build/keyhole] [--scenes box,rooms] [--method ipm] [--passes 1,3,10,30,100] [--memory 4MiB]
                             [--resolution 160x120] [--reference-time 60] [-D KEY=VALUE ...] [--out passes]

References are two independent pictures by bidirectional tracing, which stay in the folder; their own noise drops out of the error
(keyhole diff). The slope is that of a least-squares line through all points. A render without bias has -1; where bias is left the
curve flattens.
"""
import argparse
import json
import math
import pathlib
import subprocess

from common import diff

ROOT = pathlib.Path(__file__).resolve().parent.parent


def render(args, scene, out, *options):
    stats = out.with_suffix(".json")
    subprocess.run([args.keyhole, "render", scene, "-q", "-t", "1", "--no-png", "-o", out, "--stats", stats, "--resolution",
                    args.resolution, *options], check=True)
    return json.loads(stats.read_text())


def references(args, name, scene):
    files = [pathlib.Path(args.out) / f"{name}-{args.resolution}-reference-{seed}.exr" for seed in (1001, 1002)]
    for seed, file in zip((1001, 1002), files):
        if not file.exists():
            render(args, scene, file, "--cpu-time", args.reference_time, "-D", f"method={args.reference_method}", "-D", f"seed={seed}")
    return files


def relative_mse(args, picture, reference):
    return diff(args.keyhole, picture, *reference)["cross"]


def slope(points):
    x, y = [math.log(p) for p, _ in points], [math.log(e) for _, e in points]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=str(ROOT / "build/keyhole"))
    parser.add_argument("--scenes", default="box,rooms")
    parser.add_argument("--method", default="ipm")
    parser.add_argument("--passes", default="1,3,10,30,100")
    parser.add_argument("--memory", default="4MiB")
    parser.add_argument("--resolution", default="160x120")
    parser.add_argument("--reference-time", default="60")
    parser.add_argument("--reference-method", default="bdpt")
    parser.add_argument("-D", action="append", default=[], dest="settings")
    parser.add_argument("--out", default="passes")
    args = parser.parse_args()
    pathlib.Path(args.out).mkdir(parents=True, exist_ok=True)
    print("| scene | passes | CPU s | MiB allocated | relative MSE |\n| --- | --- | --- | --- | --- |")
    settings = [word for s in args.settings for word in ("-D", s)]
    for name in args.scenes.split(","):
        scene = str(ROOT / "scenes" / f"{name}.yaml")
        reference = references(args, name, scene)
        points = []
        for passes in args.passes.split(","):
            picture = pathlib.Path(args.out) / f"{name}-{passes}.exr"
            stats = render(args, scene, picture, "--passes", passes, "--photon-memory", args.memory, "-D", f"method={args.method}", *settings)
            error = relative_mse(args, picture, reference)
            points.append((int(passes), error))
            seconds = sum(stage["cpu_seconds"] for stage in stats["stages"])
            print(f"| {name} | {passes} | {seconds:.1f} | {stats['photon_bytes'] / 2**20:.2f} | {error:.5f} |", flush=True)
        print(f"| {name} | slope | | | {slope(points):.2f} |", flush=True)


if __name__ == "__main__":
    main()
