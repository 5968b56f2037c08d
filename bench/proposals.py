#!/usr/bin/python3
"""What each kind of proposal buys: error of `keyhole render --method mlt` (or mps) at equal CPU time, with each kind left out and with
each alone beside the bidirectional one. Writes a CSV, a chart (SVG) and a table (Markdown).

    apt-get install python3-numpy python3-openimageio python3-matplotlib
    bench/proposals.py build/keyhole --out /tmp/proposals [--scenes box rooms lantern] [--method mlt] [--seeds 2] [--mutations 300000]

The error is the relative mean squared error of the layers indirect + caustic against two independent path-traced pictures:
mean of (A - R1)(A - R2) / (R^2 + 0.01 mean(R)^2), without the worst 0.5 % of the pixels, which is free of the references' noise.
A is scaled to the references' mean: brightness comes from stage one, whatever the chains do. The error falls with one over the
number of mutations, so error times CPU seconds of the chains tells what an equal time would bring.
"""
import argparse
import csv
import json
import os
import statistics
import subprocess
import sys

import numpy

from common import luminance

KINDS = {
    "bidirectional": "BD", "light_tracing": "LT", "mirrored_light_tracing": "LM", "lens_subpath": "LS", "lens_perturbation": "LP",
    "multi_chain_perturbation": "MC", "caustic_perturbation": "CP", "photon_map": "PM",
}
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")


def configurations():
    """Name -> settings."""
    yield "all", {}
    for kind, short in KINDS.items():
        if kind != "bidirectional":
            yield f"without {short}", {f"{kind}.weight": 0}
    yield "BD alone", {f"{k}.weight": 0 for k in KINDS if k != "bidirectional"}
    for kind, short in KINDS.items():
        if kind != "bidirectional":
            yield f"BD + {short}", {f"{k}.weight": 0 for k in KINDS if k not in ("bidirectional", kind)}


def indirect(path):
    """Luminance of the layers that chains draw."""
    return sum(luminance(path, layer) for layer in ("indirect", "caustic"))


def error(a, r1, r2, trim=0.005):
    mean = (r1 + r2) / 2
    a = a * (mean.mean() / a.mean())
    terms = numpy.sort(((a - r1) * (a - r2) / (mean**2 + 0.01 * mean.mean() ** 2)).ravel())
    return float(terms[: int(len(terms) * (1 - trim))].mean())


class Bench:
    def __init__(self, options):
        self.o = options
        os.makedirs(options.out, exist_ok=True)

    def render(self, scene, name, seed, settings):
        """Pixels and statistics; a picture that is there already is not rendered again."""
        exr = os.path.join(self.o.out, f"{scene}-{name.replace(' ', '_')}-{seed}.exr")
        stats = exr.replace(".exr", ".json")
        if not os.path.exists(stats):
            command = [self.o.program, "render", os.path.join(ROOT, "scenes", scene + ".yaml"), "-o", exr, "--no-png", "-q",
                       "--stats", stats, "--resolution", self.o.resolution, "--seed", str(seed)]
            for key, value in settings.items():
                command += ["-D", f"{key}={value}"]
            subprocess.run(command, check=True)
        with open(stats, encoding="utf-8") as f:
            return indirect(exr), json.load(f)

    def references(self, scene):
        return [self.render(scene, "path", seed, {"method": "path", "spp": self.o.reference_spp})[0] for seed in (901, 902)]

    def measure(self, scene):
        r1, r2 = self.references(scene)
        for name, settings in configurations():
            for seed in range(1, self.o.seeds + 1):
                common = {"method": self.o.method, "spp": self.o.spp, "mutations": self.o.mutations,
                          "brightness_samples": self.o.brightness_samples}
                picture, stats = self.render(scene, name, seed, common | settings)
                seconds = sum(s["cpu_seconds"] for s in stats["stages"] if s["name"] in ("chains", "photons"))
                acceptance = {p["name"]: p["accepted"] / max(1, p["proposed"]) for p in stats["proposals"]}
                yield {"scene": scene, "configuration": name, "seed": seed, "error": error(picture, r1, r2),
                       "cpu_seconds": seconds, "acceptance": stats["values"]["chains, acceptance"],
                       "r_hat": stats["values"].get("chains, split R-hat"),
                       **{f"acceptance {short}": acceptance.get(kind) for kind, short in KINDS.items()}}


def summarise(rows):
    """(scene, configuration) -> error times seconds relative to that of all kinds, and acceptance; medians over seeds."""
    cost = {}
    for row in rows:
        cost.setdefault((row["scene"], row["configuration"]), []).append((row["error"] * row["cpu_seconds"], row["acceptance"]))
    median = {k: (statistics.median(c for c, _ in v), statistics.median(a for _, a in v)) for k, v in cost.items()}
    return {(s, c): (v / median[s, "all"][0], a) for (s, c), (v, a) in median.items()}


def write_table(rows, scenes, path):
    summary = summarise(rows)
    with open(path, "w", encoding="utf-8") as f:
        f.write("| proposals | " + " | ".join(scenes) + " |\n|" + " --- |" * (len(scenes) + 1) + "\n")
        for name, _ in configurations():
            cells = [f"{summary[s, name][0]:.2f} ({100 * summary[s, name][1]:.0f} %)" for s in scenes]
            f.write(f"| {name} | " + " | ".join(cells) + " |\n")


def write_chart(rows, scenes, path):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.fonttype"] = "none"
    matplotlib.rcParams["svg.hashsalt"] = "proposals"
    from matplotlib import pyplot
    summary = summarise(rows)
    names = [name for name, _ in configurations()]
    figure, axes = pyplot.subplots(figsize=(8, 4.2))
    width = 0.8 / len(scenes)
    for i, scene in enumerate(scenes):
        x = numpy.arange(len(names)) + (i - (len(scenes) - 1) / 2) * width
        axes.bar(x, [summary[scene, n][0] for n in names], width, label=scene)
    axes.axhline(1, color="black", linewidth=0.8)
    axes.set_ylabel("error at equal CPU time,\nrelative to all kinds")
    axes.set_xticks(range(len(names)), names, rotation=45, ha="right")
    axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("program")
    p.add_argument("--out", required=True, help="folder for pictures and results")
    p.add_argument("--scenes", nargs="+", default=["box", "rooms", "lantern"])
    p.add_argument("--method", choices=["mlt", "mps"], default="mlt")
    p.add_argument("--seeds", type=int, default=2)
    p.add_argument("--mutations", type=int, default=300_000)
    p.add_argument("--brightness-samples", type=int, default=100_000)
    p.add_argument("--spp", type=int, default=16)
    p.add_argument("--reference-spp", type=int, default=512)
    p.add_argument("--resolution", default="96x54")
    options = p.parse_args()
    bench, rows = Bench(options), []
    for scene in options.scenes:
        for row in bench.measure(scene):
            rows.append(row)
            print(f"{scene} {row['configuration']} {row['seed']}: {row['error']:.4f} in {row['cpu_seconds']:.1f} s", file=sys.stderr)
    with open(os.path.join(options.out, "proposals.csv"), "w", newline="", encoding="utf-8") as f:
        writer = csv.DictWriter(f, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    write_table(rows, options.scenes, os.path.join(options.out, "proposals.md"))
    write_chart(rows, options.scenes, os.path.join(options.out, "proposals.svg"))


if __name__ == "__main__":
    main()
