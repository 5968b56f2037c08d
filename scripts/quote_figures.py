#!/usr/bin/env python3
"""Puts the figures of a chart into README.md and docs/charts.md, between their markers, and its drawings into docs/images.

usage: scripts/quote_figures.py REPORT     REPORT: the folder that keyhole chart wrote

A marker is a line `<!-- chart: NAME -->`; what stands between it and `<!-- /chart -->` is replaced. NAME is a function below.
"""
import csv
import pathlib
import re
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
METHODS = {"auto": "auto", "mps": "Metropolis photon sampling (`mps`)", "ipm": "light tracing by importance (`ipm`)",
           "pm": "photon mapping (`pm`)", "mlt": "Metropolis light transport (`mlt`)", "pssmlt": "primary-sample-space (`pssmlt`)",
           "mmlt": "multiplexed (`mmlt`)", "bdpt": "bidirectional (`bdpt`)", "path": "path tracing (`path`)"}


def rows(report, name):
    with open(report / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def percent(x):
    if not x:
        return "–"
    value = 100 * float(x)
    return f"{value:.0f} %" if value >= 10 else f"{value:.2g} %"


def table(head, lines):
    return "\n".join("| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head), *lines])


def by_scene(report, cell):
    """Methods down, scenes across; the least value of a column is bold."""
    data = {(r["scene"], r["method"]): r for r in rows(report, "methods")}
    scenes = list(dict.fromkeys(s for s, _ in data))
    methods = list(dict.fromkeys(m for _, m in data))
    value = {key: cell(key, r) for key, r in data.items()}
    best = {s: min((value[s, m][0] for m in methods if (s, m) in value), default=None) for s in scenes}

    def shown(scene, method):
        number, text = value.get((scene, method), (None, "–"))
        return f"**{text}**" if number is not None and number == best[scene] and number != float("inf") else text

    return table(["", *scenes], [[METHODS.get(m, f"`{m}`"), *(shown(s, m) for s in scenes)] for m in methods])


def errors(report):
    """Error of each method after the longest time."""
    return by_scene(report, lambda key, r: (float(r["error_at_longest"] or "inf"), percent(r["error_at_longest"])))


def times(report):
    """CPU seconds to an error of 10 %."""
    def cell(key, r):
        t = r["seconds_to_0.1"]
        return (float(t), f"{float(t):.2g} s") if t else (float("inf"), "–")
    return by_scene(report, cell)


def slopes(report):
    return by_scene(report, lambda key, r: (float("inf"), f"{float(r['slope']):.2f}" if r["slope"] else "–"))


def parts(report):
    """Bias and deviation of the methods that keep photons, after the longest time."""
    longest = max(float(r["seconds"]) for r in rows(report, "points"))
    lines = []
    for r in rows(report, "points"):
        if float(r["seconds"]) == longest and r["memory"] == "0" and int(r["photons"]) > 0 and r["variance"]:
            root = lambda x: percent(max(0.0, float(x)) ** 0.5)
            lines.append([r["scene"], f"`{r['method']}`", root(r["squared_bias"]), root(r["variance"]),
                          f"{int(r['photons']):,}", f"{int(r['photon_bytes']) / 2**20:.1f} MiB"])
    return table(["scene", "method", "bias", "standard deviation", "photons", "memory"], lines)


def memory(report):
    """Error over the memory for photons."""
    limited = [r for r in rows(report, "points") if r["memory"] != "0"]
    sizes = sorted({int(r["memory"]) for r in limited})
    keys = list(dict.fromkeys((r["scene"], r["method"]) for r in limited))
    at = {(r["scene"], r["method"], int(r["memory"])): percent(r["error"]) for r in limited}
    return table(["scene", "method", *(f"{s / 2**20:.3g} MiB" for s in sizes)],
                 [[s, f"`{m}`", *(at.get((s, m, size), "–") for size in sizes)] for s, m in keys])


def quote(path, report):
    text = path.read_text()
    known = {f.__name__: f for f in (errors, times, slopes, parts, memory)}
    new = re.sub(r"(<!-- chart: (\w+) -->\n).*?(<!-- /chart -->)", lambda m: m[1] + known[m[2]](report) + "\n" + m[3], text, flags=re.S)
    path.write_text(new)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    report = pathlib.Path(sys.argv[1])
    for path in (ROOT / "README.md", ROOT / "docs/charts.md"):
        quote(path, report)
    for picture in sorted((report / "figures").glob("*.svg")):
        shutil.copy(picture, ROOT / "docs/images" / f"chart-{picture.name}")


if __name__ == "__main__":
    main()
