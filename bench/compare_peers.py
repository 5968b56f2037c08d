#!/usr/bin/python3
"""Error of Keyhole's pictures at given CPU times, beside that of other renderers.

usage: bench/compare_peers.py KEYHOLE SHARED [--scenes box,rooms,lantern] [--budgets 5,15,45] [--set KEY=VALUE ...]

SHARED holds scenes/mps/NAME.pbrt, references/mps/NAME.{a,b}.exr and tools/picture_error.py. Renders each scene on one
thread with the settings of BUDGETS and prints the CPU seconds of the whole process and the trimmed relative squared
error free of the references' noise (cross_trim), with the bound it is to stay below: a quarter of the best peer's.
"""
import argparse, json, os, subprocess, sys, tempfile
from common import render

# Settings meant to use about so many CPU seconds; what they do use is printed. The Box lives by its photons (caustics
# seen in mirrors), the others by the rays of their irradiance records. filter=box is what the references have.
COMMON = "method=ipm filter=box"
BUDGETS = {"box": {5: "spp=3 light_samples=8 light_paths=450k photons=200k cache_rays=500",
                   15: "spp=8 light_paths=2400k photons=500k cache_rays=1200",
                   45: "spp=24 light_paths=8M photons=1M cache_rays=3000"},
           "rooms": {5: "spp=3 light_samples=8 light_paths=450k photons=150k cache_rays=2000",
                     15: "spp=6 light_samples=16 light_paths=2100k photons=700k cache_rays=5500",
                     45: "spp=12 light_samples=24 light_paths=8M photons=2500k cache_rays=16000"},
           "lantern": {5: "spp=2 light_samples=16 light_paths=400k photons=100k cache_rays=3200",
                       15: "spp=6 light_samples=24 light_paths=1200k photons=300k cache_rays=8500",
                       45: "spp=10 light_samples=32 light_paths=3M photons=600k cache_rays=25000"}}
BOUND = {"box": {5: .0018, 15: .0012, 45: .0009},
         "rooms": {5: .0028, 15: .0005, 45: .0002},
         "lantern": {5: .0065, 15: .0021, 45: .0021}}
MASK = {"lantern": ["--mask", "110,190,70,160"]}


def error(shared, name, picture):
    references = [f"{shared}/references/mps/{name}.{x}.exr" for x in "ab"]
    out = subprocess.run([sys.executable, f"{shared}/tools/picture_error.py", picture, *references, *MASK.get(name, [])],
                         check=True, capture_output=True, text=True).stdout
    return json.loads(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("keyhole")
    parser.add_argument("shared")
    parser.add_argument("--scenes", default="box,rooms,lantern")
    parser.add_argument("--budgets", default="5,15,45")
    parser.add_argument("--set", nargs="*", default=[], metavar="KEY=VALUE")
    parser.add_argument("--keep", metavar="FOLDER", help="where pictures stay")
    args = parser.parse_args()
    print(f"{'scene':<10}{'budget':>7}{'CPU s':>8}{'cross_trim':>12}{'bound':>8}{'block':>8}{'ratio':>8}")
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.keep or scratch
        for name in args.scenes.split(","):
            for budget in map(int, args.budgets.split(",")):
                picture = os.path.join(folder, f"{name}-{budget}.exr")
                settings = f"{COMMON} {BUDGETS[name][budget]}".split() + args.set
                seconds = render(args.keyhole, f"{args.shared}/scenes/mps/{name}.pbrt", settings, picture)
                e = error(args.shared, name, picture)
                print(f"{name:<10}{budget:>7}{seconds:>8.1f}{e['cross_trim']:>12.5f}{BOUND[name][budget]:>8}"
                      f"{e['block']:>8.3f}{e['ratio']:>8.3f}", flush=True)


if __name__ == "__main__":
    main()
