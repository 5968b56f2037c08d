#!/usr/bin/env python3
"""Every method, and what `auto` makes of the time, on scenes that other people made.

usage: bench/outside.py [--keyhole build/keyhole] [--shared ../shared] [--own] [--scenes coffee,...] [--times 5,15,60]
                        [--methods auto,path,...] [--best N] [--seeds 1,2,3] [--denoise off] [--reference-seconds 240] [-j 2]
                        [--out outside] [--at-most 1.25]

Renders each scene at the size of its given reference, one thread a render, by `--cpu-time`. The error is the trimmed relative
squared error free of the references' own noise (`keyhole diff`, cross_trim), against two independent long renders of our own,
which stay in OUT/references; with several seeds it is the median over them; how far their blocks are from the reference that was given stands in OUT/references.json. Results
stay in OUT/results.json, so that a run that was interrupted goes on, and more scenes, times or methods add to it. --best N
leaves out, at all times but the shortest, methods that were not among the N best of the scene at the time before.
--denoise exr measures pictures as the filter at the end leaves them.
--own takes the scenes of this project instead, those where methods fail among them. With --at-most the status is 1 if auto
has more than so many times the error of the best method anywhere.
The table has a row for each scene and time; the last columns are the best method by name and auto over it.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import statistics
import subprocess
import sys
import threading
import time

from common import diff

ROOT = pathlib.Path(__file__).resolve().parent.parent
METHODS = "auto,path,bdpt,mlt,pssmlt,mmlt,rjmlt,ipm,mps,pm"
# Size, the method of the long renders, and the reference that was given (if it has the size).
SCENES = {
    "coffee": ("100x125", "path", "references/coffee.exr"),
    "bathroom": ("128x128", "bdpt", "references/bathroom.exr"),
    "dining-room": ("160x90", "bdpt", "references/dining-room.exr"),
    "veach-ajar": ("160x90", "mmlt", "references/veach-ajar.a.exr"),
    "cornell-box": ("128x128", "bdpt", "references/cornell-box.exr"),
    "veach-bidir": ("128x128", "bdpt", "references/veach-bidir.exr"),
    "water-caustic": ("128x128", "ipm", None), # light through water is for photons alone; the given one has another size
    "mps/box": ("320x240", "ipm", "references/mps/box.a.exr"),
    "mps/rooms": ("320x240", "ipm", "references/mps/rooms.a.exr"),
    "mps/lantern": ("320x240", "ipm", "references/mps/lantern.a.exr"),
}
# Of this project; those whose picture is black or a single colour have nothing to compare.
OWN = {f"own/{name}": ("96x72", method, None) for name, method in {
    "box": "ipm", "rooms": "ipm", "lantern": "bdpt", "disco": "ipm", "egg": "ipm", "glossy": "ipm", "tube": "ipm", "ball": "path",
    "failures/grazing": "path", "failures/inside_glass": "ipm", "failures/islands": "mmlt", "failures/keyhole": "mlt",
    "failures/many_lights": "bdpt", "failures/room": "ipm", "failures/sds": "ipm", "failures/stadium": "bdpt",
    "failures/sun_glass": "ipm", "failures/thin_wall": "bdpt", "failures/tiny_caustic": "bdpt"}.items()}
SCENES |= OWN


def scene_file(shared, name):
    if name in OWN:
        return str(ROOT / "scenes" / f"{name.removeprefix('own/')}.yaml")
    return f"{shared}/scenes/{name}.pbrt" if name.startswith("mps/") else f"{shared}/scenes/{name}/scene.pbrt"


def render(args, name, picture, seconds, method, seed, denoise="off"):
    """Renders; returns the CPU seconds that the process took and its statistics. Runs in a thread of its own."""
    stats = f"{picture}.json"
    command = [args.keyhole, "render", scene_file(args.shared, name), "-q", "-t", "1", "--no-png", "-o", picture, "--stats", stats,
               "--resolution", SCENES[name][0], "--method", method, "--seed", str(seed), "--cpu-time", str(seconds),
               "--denoise", denoise]
    child = subprocess.Popen(command)
    usage = os.wait4(child.pid, 0)
    if usage[1] != 0:
        raise SystemExit(f"{' '.join(command)}: status {usage[1]}")
    with open(stats) as file:
        told = json.load(file)
    os.remove(stats)
    return usage[2].ru_utime + usage[2].ru_stime, told


class Results:
    """A dictionary in a file."""
    def __init__(self, path):
        self.path, self.lock = path, threading.Lock()
        self.found = json.loads(path.read_text()) if path.exists() else {}

    def add(self, key, value):
        with self.lock:
            self.found[key] = value
            self.path.write_text(json.dumps(self.found, indent=1, sort_keys=True))


def references(args, folder, name):
    return [str(folder / f"{name.replace('/', '-')}.{x}.exr") for x in "ab"]


def make_references(args, folder, pool):
    folder.mkdir(parents=True, exist_ok=True)
    wanted = [(name, picture, 1001 + i) for name in args.scenes for i, picture in enumerate(references(args, folder, name))
              if not os.path.exists(picture)]
    list(pool.map(lambda w: render(args, w[0], w[1], args.reference_seconds, SCENES[w[0]][1], w[2]), wanted))
    checked = {}
    for name in args.scenes:
        a, b = references(args, folder, name)
        checked[name] = {"halves": diff(args.keyhole, a, b)["block"]}
        given = SCENES[name][2]
        if given:
            e = diff(args.keyhole, a, f"{args.shared}/{given}")
            checked[name] |= {"given": e["block"], "ratio": e["ratio"]}
        print(name, checked[name], flush=True)
    (folder.parent / "references.json").write_text(json.dumps(checked, indent=1))


def measure(args, results, folder, name, seconds, method, seed):
    picture = str(folder / f"{name.replace('/', '-')}-{seconds:g}-{method}-{seed}.exr")
    start = time.monotonic()
    used, told = render(args, name, picture, seconds, method, seed, args.denoise)
    e = diff(args.keyhole, picture, *references(args, folder.parent / "references", name))
    error = float("inf") if e["cross_trim"] is None else e["cross_trim"] # a black picture has none
    results.add(f"{name} {seconds:g} {method} {seed}",
                {"error": error, "ratio": e["ratio"], "block": e["block"], "bad": e["bad"], "seconds": used,
                 "wall": time.monotonic() - start, "method": told["method"], "warnings": told.get("warnings", [])})
    print(f"{name:15}{seconds:>5g} {method:7}{error:10.5f}  {used:6.2f} s  {told['method']}", flush=True)


def median_error(args, results, name, seconds, method):
    """The median error over the seeds, and the methods that made the pictures; None if there is none."""
    found = [r for seed in args.seeds if (r := results.found.get(f"{name} {seconds:g} {method} {seed}"))]
    if not found:
        return None
    return statistics.median(r["error"] for r in found), ", ".join(sorted({r["method"] for r in found}))


def contenders(args, results, name, before):
    """The methods to try where those of a shorter time are known."""
    if not args.best or before is None:
        return args.methods
    known = {m: cell[0] for m in args.methods if m != "auto" and (cell := median_error(args, results, name, before, m))}
    return ["auto"] * ("auto" in args.methods) + sorted(known, key=known.get)[:args.best]


def table(args, results):
    print("\n| scene | s | " + " | ".join(args.methods) + " | best | auto over best |\n" + "| --- " * (len(args.methods) + 4) + "|")
    ratios = []
    for name in args.scenes:
        for seconds in args.times:
            row = {m: median_error(args, results, name, seconds, m) for m in args.methods}
            errors = {m: cell[0] for m, cell in row.items() if cell and m != "auto"}
            if not errors:
                continue
            best = min(errors, key=errors.get)
            ratio = row["auto"][0] / errors[best] if row.get("auto") else float("nan")
            ratios.append(ratio)
            cells = [("" if not cell else f"{cell[0]:.2g}" + (f" ({cell[1]})" if m == "auto" else "")) for m, cell in row.items()]
            print(f"| {name} | {seconds:g} | " + " | ".join(cells) + f" | {best} | {ratio:.2f} |")
    if ratios:
        print(f"\nauto over best: median {statistics.median(ratios):.2f}, largest {max(ratios):.2f}")
    return max(ratios, default=0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=str(ROOT / "build/keyhole"))
    parser.add_argument("--shared", default=str(ROOT.parent / "shared"))
    parser.add_argument("--own", action="store_true")
    parser.add_argument("--scenes")
    parser.add_argument("--times", default="5,15,60")
    parser.add_argument("--methods", default=METHODS)
    parser.add_argument("--best", type=int, default=0)
    parser.add_argument("--seeds", default="1")
    parser.add_argument("--denoise", default="off", help="off, or exr: of pictures that were filtered")
    parser.add_argument("--reference-seconds", type=float, default=240)
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--out", default="outside")
    parser.add_argument("--at-most", type=float, default=float("inf"))
    args = parser.parse_args()
    args.scenes = args.scenes.split(",") if args.scenes else [name for name in SCENES if (name in OWN) == args.own]
    args.methods, args.seeds = args.methods.split(","), args.seeds.split(",")
    args.times = [float(t) for t in args.times.split(",")]
    folder = pathlib.Path(args.out) / "pictures"
    folder.mkdir(parents=True, exist_ok=True)
    results = Results(pathlib.Path(args.out) / "results.json")
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        make_references(args, folder.parent / "references", pool)
        for before, seconds in zip([None, *args.times], args.times):
            wanted = [(name, seconds, m, seed) for name in args.scenes for m in contenders(args, results, name, before)
                      for seed in args.seeds if f"{name} {seconds:g} {m} {seed}" not in results.found]
            list(pool.map(lambda w: measure(args, results, folder, *w), wanted))
    return 1 if table(args, results) > args.at_most else 0


if __name__ == "__main__":
    sys.exit(main())
