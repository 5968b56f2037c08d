#!/usr/bin/env python3
"""Table 1 of Fan, Chenney, Lai 2005 on scenes of our own: RMS relative error of photon mapping over that of Metropolis photon sampling
at equal CPU time, with light tracing by importance (ipm) beside them. What ipm gains over pm is due to where photons are stored, what mps
gains over ipm to Metropolis sampling.

usage: bench/table1.py [--keyhole build/keyhole] [--scenes rooms,lantern,box] [--time 8] [--repeats 2] [--resolution 160x120]
                       [--reference-time 90] [--out table1] [-D KEY=VALUE ...]

Errors, with their references, are those of keyhole chart, which goes on where it was interrupted.
"""
import argparse
import csv
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAPER = {"rooms": "11.8", "lantern": "16", "box": "1.06"}
METHODS = ("pm", "ipm", "mps")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=str(ROOT / "build/keyhole"))
    parser.add_argument("--scenes", default="rooms,lantern,box")
    parser.add_argument("--time", default="8")
    parser.add_argument("--repeats", default="2")
    parser.add_argument("--resolution", default="160x120")
    parser.add_argument("--reference-time", default="90")
    parser.add_argument("-D", action="append", default=[], dest="settings")
    parser.add_argument("--out", default="table1")
    args = parser.parse_args()
    settings = [word for s in args.settings for word in ("-D", s)]
    print("| scene | `pm` | `ipm` | `mps` | pm / mps | paper | pm / ipm | ipm / mps | photons, `mps` over `pm` |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for name in args.scenes.split(","):
        folder = pathlib.Path(args.out) / name
        subprocess.run([args.keyhole, "chart", ROOT / "scenes" / f"{name}.yaml", "--methods", ",".join(METHODS), "--times", args.time,
                        "--repeats", args.repeats, "--resolution", args.resolution, "--reference-time", args.reference_time, *settings,
                        "-o", folder], check=True, stdout=subprocess.DEVNULL)
        with open(folder / "points.csv", newline="") as file:
            rows = {r["method"]: r for r in csv.DictReader(file)}
        pm, ipm, mps = (float(rows[m]["error"]) for m in METHODS)
        photons = float(rows["mps"]["photons"]) / float(rows["pm"]["photons"])
        print(f"| {name} | {pm:.3f} | {ipm:.3f} | {mps:.3f} | {pm / mps:.2f} | {PAPER.get(name, '')} | {pm / ipm:.2f} | {ipm / mps:.2f} "
              f"| {photons:.2f} |", flush=True)


if __name__ == "__main__":
    main()
