#!/usr/bin/env python3
"""What user paths buy: the error of --method mlt with them and without, over the number of samples.

Renders a scene with independent seeds and takes the variance between them of what the chains draw (indirect light and
caustics), by blocks of the image or within one region; every picture is divided by its own estimate of brightness, so
that only the chains' error is left. No reference is needed: both are unbiased, as the agreement tests show.

    bench/user_paths.py --keyhole build/keyhole --chart docs/images/user-paths.svg

prints a table and, with --chart, draws it. Needs numpy, OpenImageIO and, for the chart, matplotlib.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy

from common import luminance

ROOT = pathlib.Path(__file__).resolve().parent.parent
SIZE = (96, 64)
BLOCK = 8
# name, scene, layers, region of the picture (x0, y0, x1, y1 as shares; none: all of it, by blocks)
CASES = [
    ("Rooms", "rooms", ("indirect", "caustic"), None),
    ("Box", "box", ("indirect", "caustic"), None),
    ("Box, small caustic", "box", ("caustic",), (0.44, 0.85, 0.53, 0.93)),
]


def render(keyhole, scene, guided, mutations, seed, folder):
    exr, stats = folder / "p.exr", folder / "s.json"
    command = [keyhole, "render", ROOT / f"scenes/{scene}.yaml", "--method", "mlt", "-q", "--no-png", "-o", exr,
               "--stats", stats, "--resolution", f"{SIZE[0]}x{SIZE[1]}", "--spp", "1", "--seed", seed,
               "--mutations", mutations, "-D", "chains=200", "-D", "brightness_samples=100k"]
    if guided:
        command += ["--user-paths", ROOT / f"userpaths/{scene}.yaml"]
    subprocess.run([str(c) for c in command], check=True)
    s = json.loads(stats.read_text())
    user = [p for p in s["proposals"] if p["name"].startswith("user path")]
    moved = {"acceptance": s["values"]["chains, acceptance"],
             "user accepted": sum(p["accepted"] for p in user) / max(1, sum(p["proposed"] for p in user))}
    return {layer: luminance(exr, layer) / s["brightness"] for layer in ("indirect", "caustic")}, moved


def values(layers, names, region):
    total = sum(layers[n] for n in names)
    if region:
        x0, y0, x1, y1 = (round(r * SIZE[i % 2]) for i, r in enumerate(region))
        return numpy.array([total[y0:y1, x0:x1].mean()])
    h, w = total.shape
    return total.reshape(h // BLOCK, BLOCK, w // BLOCK, BLOCK).mean(axis=(1, 3)).ravel()


def relative_variance(pictures, names, region):
    v = numpy.array([values(p, names, region) for p in pictures])
    return v.var(axis=0, ddof=1).sum() / (v.mean(axis=0) ** 2).sum()


def chart(rows, path):
    import matplotlib
    matplotlib.use("svg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(1, len(CASES), figsize=(11, 3.4))
    for axis, (name, *_) in zip(axes, CASES):
        for guided, label in ((False, "without"), (True, "with ten user paths")):
            points = [(r["mutations"], r["variance"] ** 0.5) for r in rows if r["case"] == name and r["guided"] == guided]
            axis.loglog(*zip(*points), "o-", label=label)
        axis.set(title=name, xlabel="mutations", ylabel="relative error")
        axis.legend()
    figure.tight_layout()
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=ROOT / "build/keyhole")
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--mutations", type=int, nargs="+", default=[50_000, 200_000, 800_000])
    parser.add_argument("--chart")
    options = parser.parse_args()
    rows = []
    print(f"{'case':20}{'mutations':>10}{'guided':>8}{'relative variance':>19}{'acceptance':>12}{'of user paths':>15}")
    with tempfile.TemporaryDirectory() as scratch:
        for scene in ("rooms", "box"):
            for mutations in options.mutations:
                for guided in (False, True):
                    runs = [render(options.keyhole, scene, guided, mutations, seed, pathlib.Path(scratch))
                            for seed in range(1, options.seeds + 1)]
                    moved = {k: numpy.mean([r[1][k] for r in runs]) for k in runs[0][1]}
                    for name, of, layers, region in CASES:
                        if of != scene:
                            continue
                        variance = relative_variance([r[0] for r in runs], layers, region)
                        rows.append({"case": name, "mutations": mutations, "guided": guided, "variance": variance})
                        print(f"{name:20}{mutations:>10}{'yes' if guided else 'no':>8}{variance:>19.3e}"
                              f"{moved['acceptance']:>12.3f}{moved['user accepted']:>15.4f}", flush=True)
    if options.chart:
        chart(rows, options.chart)


if __name__ == "__main__":
    sys.exit(main())
