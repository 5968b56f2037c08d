#!/usr/bin/env python3
"""How far the settings that a time budget chooses are from the best that a sweep finds: each of the main ones halved and doubled,
the others set by the rest of the time.

usage: bench/sweep.py [--keyhole build/keyhole] [--scenes box,rooms,lantern] [--times 3,10,30] [--resolution 160x120]
                      [--repeats 3] [--out sweep]

The settings that were chosen are read from a render; errors come from keyhole chart, which goes on where it was interrupted. Prints for
each scene and time the error of the choice, the best of the sweep and the ratio of the two. The best of many noisy figures is a little
too good, so the ratio errs against the choice. References are shared by the times of a scene.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
MAIN = ("spp", "photons", "light_paths", "cache_rays", "gather_rays", "nearest", "cache_error")
# What isn't told is as it is by default; of gather rays, which are as many as pay, about that.
DEFAULTS = {"spp": 16, "light_paths": 1_000_000, "cache_rays": 400, "gather_rays": 4, "nearest": 60, "cache_error": 0.3}


def chosen(args, scene, seconds):
    with tempfile.TemporaryDirectory() as scratch:
        stats = pathlib.Path(scratch) / "stats.json"
        subprocess.run([args.keyhole, "render", scene, "-q", "-t", "1", "--no-png", "-o", f"{scratch}/a.exr", "--stats", stats,
                        "--cpu-time", str(seconds), "--resolution", args.resolution, "-D", "method=auto"], check=True)
        told = json.loads(stats.read_text())
    remark = next(r for r in told["remarks"] if r.startswith("set by the time:"))
    return {**DEFAULTS, **dict(re.findall(r"(\w+)=(\S+)", remark)), "method": told["method"]}


def variants(settings):
    method = settings["method"]
    for key in MAIN:
        for factor in (0.5, 2):
            value = float(settings[key]) * factor
            yield f"{method}:{key}={min(value, 1):g}" if key == "cache_error" else f"{method}:{key}={max(1, round(value))}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=str(ROOT / "build/keyhole"))
    parser.add_argument("--scenes", default="box,rooms,lantern")
    parser.add_argument("--times", default="3,10,30")
    parser.add_argument("--resolution", default="160x120")
    parser.add_argument("--repeats", default="3")
    parser.add_argument("--reference-time", default="240")
    parser.add_argument("--out", default="sweep")
    args = parser.parse_args()
    print("| scene | s | error | best of the sweep | | ratio |\n| --- | --- | --- | --- | --- | --- |")
    for name in args.scenes.split(","):
        scene = str(ROOT / "scenes" / f"{name}.yaml")
        for seconds in args.times.split(","):
            methods = ["auto", *variants(chosen(args, scene, seconds))]
            folder = pathlib.Path(args.out) / name
            subprocess.run([args.keyhole, "chart", scene, "--methods", ",".join(methods), "--times", seconds, "--repeats", args.repeats,
                            "--resolution", args.resolution, "--reference-time", args.reference_time, "-o", folder], check=True)
            with open(folder / "points.csv", newline="") as file:
                errors = {r["method"]: float(r["error"]) for r in csv.DictReader(file)
                          if r["method"] in methods and float(r["seconds"]) == float(seconds)}
            best = min(errors, key=errors.get)
            print(f"| {name} | {seconds} | {errors['auto']:.4f} | {errors[best]:.4f} | `{best}` | {errors['auto'] / errors[best]:.2f} |",
                  flush=True)


if __name__ == "__main__":
    main()
