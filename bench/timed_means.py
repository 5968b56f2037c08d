#!/usr/bin/env python3
"""Whether choosing among methods, and weighting what they make, biases timed renders.

usage: bench/timed_means.py SCENE REFERENCE [REFERENCE2] [--keyhole build/keyhole] [--seconds 3] [--renders 40] [--resolution WxH]
                            [--blocks 4] [-j 2]

Renders SCENE by `auto` with as many seeds and compares the mean of each layer, in blocks of the picture, with that of the long
references (multi-layer EXR of Keyhole's own). Prints for each layer the mean ratio and the largest deviation in standard errors,
those of the references included where there are two; 4 is what chance allows. Needs numpy and OpenImageIO for Python.
"""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import subprocess
import tempfile

import numpy

from common import luminance

LAYERS = ("", "direct", "indirect", "caustic")


def blocks(y, n):
    h, w = y.shape[0] // n * n, y.shape[1] // n * n
    return y[:h, :w].reshape(n, h // n, n, w // n).mean((1, 3))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("references", nargs="+")
    parser.add_argument("--keyhole", default=str(pathlib.Path(__file__).resolve().parent.parent / "build/keyhole"))
    parser.add_argument("--seconds", default="3")
    parser.add_argument("--renders", type=int, default=40)
    parser.add_argument("--resolution", default="160x90")
    parser.add_argument("--blocks", type=int, default=4)
    parser.add_argument("-j", "--jobs", type=int, default=2)
    args = parser.parse_args()
    methods = collections.Counter()

    def render(seed):
        picture = f"{folder}/{seed}.exr"
        subprocess.run([args.keyhole, "render", args.scene, "-q", "-t", "1", "--no-png", "-o", picture, "--stats", f"{picture}.json",
                        "--resolution", args.resolution, "--cpu-time", args.seconds, "--seed", str(seed), "-D", "method=auto"], check=True)
        methods[json.loads(pathlib.Path(f"{picture}.json").read_text())["method"]] += 1
        found = [blocks(luminance(picture, layer), args.blocks) for layer in LAYERS]
        pathlib.Path(picture).unlink()
        return found

    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        found = numpy.array(list(pool.map(render, range(1, args.renders + 1))))
    print(dict(methods))
    for k, layer in enumerate(LAYERS):
        references = numpy.array([blocks(luminance(r, layer), args.blocks) for r in args.references])
        reference, mean = references.mean(0), found[:, k].mean(0)
        error2 = found[:, k].var(0, ddof=1) / args.renders
        if len(references) > 1:
            error2 = error2 + numpy.maximum((references[0] - references[1]) ** 2 / 4, references.var(0, ddof=1).mean() / 2)
        lit = error2 > 0
        if not lit.any():
            continue
        z = (mean - reference)[lit] / numpy.sqrt(error2[lit])
        print(f"{layer or 'picture':9} ratio {mean.mean() / reference.mean():.4f} +- {numpy.sqrt(error2.mean() / error2.size) / reference.mean():.4f}   "
              f"largest deviation {abs(z).max():.2f} standard errors of {lit.sum()} blocks")


if __name__ == "__main__":
    main()
