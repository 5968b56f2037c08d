#!/usr/bin/python3
"""What the irradiance cache brings: its error beside that of five times the time without it.

usage: bench/cache_gain.py KEYHOLE SCENE... [--set KEY=VALUE ...]

Renders each scene once with the cache, in t CPU seconds on one thread, and twice without it, with other seeds and as
many samples a pixel as take 2.5 t each. The two are independent, so that their difference tells their noise and that of
their mean (5 t); with the cache the error is the mean of (I - U1)(I - U2), which is free of the noise of U1 and U2 and
includes what the cache biases. Both are relative to the squared luminance, smoothed 5x5, without the worst 0.1 % of
the pixels. Needs Debian's python3-openimageio and python3-numpy.
"""
import argparse, json, os, tempfile
import numpy as np
import common
from common import luminance

SETTINGS = "method=ipm light_paths=300k photons=100k spp=2 cache_rays=400"


def smooth(a, k=2):
    p = np.pad(a, k, mode="edge")
    n = 2 * k + 1
    return sum(p[i:i + a.shape[0], j:j + a.shape[1]] for i in range(n) for j in range(n)) / n**2


def trimmed(e):
    e = e.ravel()
    return e[np.argsort(np.abs(e))[: int(len(e) * 0.999)]].mean()


def render(keyhole, scene, settings, picture):
    seconds = common.render(keyhole, scene, settings, picture, "--stats", picture + ".json")
    with open(picture + ".json") as f:
        gather = sum(s["cpu_seconds"] for s in json.load(f)["stages"] if s["name"] == "gather")
    return seconds, gather


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("keyhole")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--set", nargs="*", default=[], metavar="KEY=VALUE")
    args = parser.parse_args()
    print(f"{'scene':<24}{'CPU s':>8}{'error':>10}{'without, CPU s':>16}{'error':>10}{'bias':>9}")
    for scene in args.scenes:
        with tempfile.TemporaryDirectory() as folder:
            name = lambda x: os.path.join(folder, x + ".exr")
            settings = SETTINGS.split() + args.set
            without = settings + ["irradiance_cache=false"]
            t, _ = render(args.keyhole, scene, settings, name("c"))
            t1, gather = render(args.keyhole, scene, without + ["spp=1"], name("u"))
            spp = max(1, round((2.5 * t - (t1 - gather)) / gather))
            times = [render(args.keyhole, scene, without + [f"spp={spp}", f"seed={seed}"], name(f"u{seed}"))[0]
                     for seed in (11, 12)]
            c, u, v = [luminance(name(x)) for x in ("c", "u11", "u12")]
            mean = (u + v) / 2
            d = smooth(mean)**2 + 0.01 * mean.mean()**2
            print(f"{scene[-23:]:<24}{t:>8.1f}{trimmed((c - u) * (c - v) / d):>10.4f}{sum(times):>16.1f}"
                  f"{trimmed((u - v)**2 / d) / 4:>10.4f}{c.mean() / mean.mean() - 1:>9.3f}", flush=True)


if __name__ == "__main__":
    main()
