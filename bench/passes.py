#!/usr/bin/env python3
"""How the error falls over passes at a fixed memory: relative MSE and its slope in logarithms.

usage: bench/passes.py SCENE.yaml [--method ipm] [--memory 4MiB] [--passes 1,3,10,30,100] [--keyhole build/keyhole]
"""
import argparse
import math
import pathlib

from keyhole_runs import Keyhole, cpu_seconds

ROOT = pathlib.Path(__file__).resolve().parent.parent


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--method", default="ipm")
    parser.add_argument("--memory", default="4MiB")
    parser.add_argument("--passes", default="1,3,10,30,100")
    parser.add_argument("--resolution", default="96x72")
    parser.add_argument("--reference", default="path", help="method of the two references")
    parser.add_argument("--reference-spp", default=2048)
    parser.add_argument("--light-paths", default="200k")
    parser.add_argument("--keyhole", default=ROOT / "build/keyhole")
    parser.add_argument("--out", default="passes")
    args = parser.parse_args()
    runs = Keyhole(args.keyhole, args.out)
    name = pathlib.Path(args.scene).stem
    references = runs.references(args.scene, f"{name}_reference", resolution=args.resolution, method=args.reference,
                                 spp=args.reference_spp)
    print("| passes | CPU s | bytes | relative MSE | estimated by the render |\n|---|---|---|---|---|")
    points = []
    for passes in map(int, args.passes.split(",")):
        picture, stats = runs.render(args.scene, f"{name}_{args.method}_{passes}", resolution=args.resolution, spp=1,
                                     method=args.method, photon_memory=args.memory, photons=0, passes=passes,
                                     light_paths=args.light_paths, mutations=args.light_paths, brightness_samples="50k",
                                     importons="100k")
        error = runs.diff(picture, references)["cross_trim"]
        points.append((math.log(passes), math.log(error)))
        estimate = stats["values"].get("relative error")
        print(f"| {passes} | {cpu_seconds(stats):.1f} | {stats['photon_bytes']} | {error:.6f} |"
              f" {estimate ** 2 if estimate else '-'} |", flush=True)
    mean_x, mean_y = (sum(p[k] for p in points) / len(points) for k in (0, 1))
    slope = sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, y in points)
    print(f"\nslope of log(relative MSE) over log(passes): {slope:.2f}")


if __name__ == "__main__":
    main()
