#!/usr/bin/env python3
"""Pictures as a user gets them, for people to look at: sheets for docs/looks.md.

usage: bench/looks.py [--keyhole build/keyhole] [--before OLDER_KEYHOLE] [--shared ../shared] [--times 5,15,45] [--scale 1]
                      [--scenes box,...] [-j 2] [--out looks]

Renders each scene by `auto`, one thread, for so many CPU seconds, and joins the PNGs, which are tone-mapped and filtered by
default, side by side: OUT/NAME.jpg. --before puts what an older program makes in the middle one of the times first. --scale N has
N times the pixels each way, and a picture of its own for each time. Scenes of ../shared are left out where it is absent.
"""
import argparse
import concurrent.futures
import pathlib
import subprocess

import numpy
import OpenImageIO as oiio

ROOT = pathlib.Path(__file__).resolve().parent.parent
OWN = {name: (ROOT / f"scenes/{name}.yaml", 320, 240) for name in ("box", "rooms", "lantern", "kitchen", "bedroom")}
OUTSIDE = {"coffee": (200, 250), "bathroom": (240, 240), "dining-room": (320, 180)}


def scenes(shared):
    found = dict(OWN)
    for name, (width, height) in OUTSIDE.items():
        path = shared / "scenes" / name / "scene.pbrt"
        if path.exists():
            found[name] = (path, width, height)
        else:
            print(f"{name}: left out, there is no {path}")
    return found


def render(keyhole, scene, width, height, seconds, png):
    subprocess.run([keyhole, "render", scene, "-q", "-t", "1", "--resolution", f"{width}x{height}", "--cpu-time", str(seconds),
                    "-o", png.with_suffix(".exr"), "--png", png], check=True)


def join(pngs, sheet):
    pixels = [oiio.ImageInput.open(str(png)).read_image(oiio.UINT8)[..., :3] for png in pngs]
    gap = numpy.full((pixels[0].shape[0], 4, 3), 255, numpy.uint8)
    row = numpy.concatenate([part for p in pixels for part in (p, gap)][:-1], axis=1)
    spec = oiio.ImageSpec(row.shape[1], row.shape[0], 3, oiio.UINT8)
    spec["Compression"] = "jpeg:90"
    file = oiio.ImageOutput.create(str(sheet))
    file.open(str(sheet), spec)
    file.write_image(numpy.ascontiguousarray(row))
    file.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=ROOT / "build/keyhole")
    parser.add_argument("--before")
    parser.add_argument("--shared", type=pathlib.Path, default=ROOT / "../shared")
    parser.add_argument("--times", default="5,15,45")
    parser.add_argument("--scale", type=int, default=1)
    parser.add_argument("--scenes", default="")
    parser.add_argument("-j", type=int, default=2)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("looks"))
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    times = [float(t) for t in args.times.split(",")]
    chosen = {n: s for n, s in scenes(args.shared).items() if not args.scenes or n in args.scenes.split(",")}
    sheets, jobs = {}, []
    for name, (scene, width, height) in chosen.items():
        runs = [(args.before, times[len(times) // 2], "before")] if args.before else []
        runs += [(args.keyhole, t, f"{t:g}s") for t in times]
        sheets[name] = [args.out / f"{name}-{label}.png" for _, _, label in runs]
        jobs += [(k, scene, width * args.scale, height * args.scale, t, png) for (k, t, _), png in zip(runs, sheets[name])]
    with concurrent.futures.ThreadPoolExecutor(args.j) as pool:
        for job in [pool.submit(render, *j) for j in jobs]:
            job.result()
    if args.scale == 1:
        for name, pngs in sheets.items():
            join(pngs, args.out / f"{name}.jpg")


if __name__ == "__main__":
    main()
