#!/usr/bin/env python3
"""Table 1 of Fan, Chenney, Lai 2005: errors of the samplers after equal CPU time, on the scenes of scenes/.

usage: bench/table1.py [--keyhole build/keyhole] [--seconds 20] [--resolution 160x120] [--out FOLDER]

Prints a table in Markdown: root of the mean squared relative error against two independent references (free of the references'
own noise, without the worst 0.1 % of the pixels), its ratio to that of mps, photons stored, and bytes.
"""
import argparse
import math
import pathlib

from keyhole_runs import Keyhole, cpu_seconds

ROOT = pathlib.Path(__file__).resolve().parent.parent
# How each scene is known to arbitrary precision: by methods that share neither photons nor lookups with those compared.
REFERENCES = {
    "box": {"method": "path", "spp": 1024},
    "rooms": {"method": "path", "spp": 1024},
    "lantern": {"method": "mlt", "spp": 256, "mutations": "20M"},
}
SAMPLERS = {
    "pm": {"method": "pm", "light_paths": "1M"},
    "ipm": {"method": "ipm", "light_paths": "1M", "importons": "200k"},
    "mps": {"method": "mps", "mutations": "500k", "brightness_samples": "100k"},
    "mps, reciprocal": {"method": "mps", "mutations": "500k", "brightness_samples": "100k", "power": "reciprocal"},
    "mps, literal": {"method": "mps", "mutations": "500k", "brightness_samples": "100k", "power": "literal"},
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=ROOT / "build/keyhole")
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--resolution", default="160x120")
    parser.add_argument("--out", default="table1")
    parser.add_argument("--scenes", nargs="*", default=list(REFERENCES))
    args = parser.parse_args()
    runs = Keyhole(args.keyhole, args.out)
    print("| scene | sampler | CPU s | passes | photons | bytes | error | over mps |\n|---|---|---|---|---|---|---|---|")
    for name in args.scenes:
        scene = ROOT / "scenes" / f"{name}.yaml"
        references = runs.references(scene, f"{name}_reference", resolution=args.resolution, **REFERENCES[name])
        rows = []
        for sampler, settings in SAMPLERS.items():
            picture, stats = runs.in_time(scene, f"{name}_{sampler.replace(', ', '_')}", args.seconds,
                                          resolution=args.resolution, spp=4, photons="100k", **settings)
            error = math.sqrt(max(0.0, runs.diff(picture, references)["cross_trim"]))
            rows.append((sampler, cpu_seconds(stats), stats["values"]["passes"],
                         stats["photons_global"] + stats["photons_caustic"], stats["photon_bytes"], error))
        mps = next(row[-1] for row in rows if row[0] == "mps")
        for sampler, cpu, passes, photons, size, error in rows:
            print(f"| {name} | {sampler} | {cpu:.1f} | {passes:.0f} | {photons} | {size / 2**20:.1f} MiB | {error:.4f} |"
                  f" {error / mps:.2f} |", flush=True)


if __name__ == "__main__":
    main()
