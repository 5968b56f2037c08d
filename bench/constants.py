#!/usr/bin/env python3
"""The numbers in src that steer: what each is for, and what half and double of it change.

usage: bench/constants.py --table > table; mv table docs/constants.md
       bench/constants.py --measure [NAME...] [--scenes box,rooms,lantern] [--method mps] [--seconds 10] [--repeats 3]

--table lists the constants that code gives a name, by file, with the comment beside them. What docs/constants.md says of a
constant's source or sweep stays; a comment that names a paper is a source; the others are `not measured`.
--measure rebuilds the program in a scratch copy with each constant halved and doubled, and compares the errors of renders of equal
CPU time with those of the program as it is, against a long reference: medians over scenes and repeats. Within the spread of the
program against itself is `arbitrary: half and double change nothing`.
"""
import argparse
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

import common

ROOT = pathlib.Path(__file__).resolve().parent.parent
TABLE = ROOT / "docs" / "constants.md"
# Formats and limits of files are no heuristics.
LEFT_OUT = ("src/scene/load/", "src/scene/images/", "src/film/files/", "src/cli/", "src/mpi/")
NUMBER = r"-?(?:0x[\da-fp.+-]+|\d[\d']*\.?\d*(?:e[-+]?\d+)?)f?|k\w+"
VALUE = rf"(?:(?:std::\w+|[A-Z]\w+)\{{)?(?:{NUMBER})\}}?(?:\s*(?:[*/+-]|<<)\s*(?:{NUMBER}))*"
DEFINITION = re.compile(rf"^\s*(?:static |inline )*constexpr (?:static )?(?!auto\b)[\w:]+ (\w+ = {VALUE}(?:, \w+ = {VALUE})*);"
                        rf"|^\s*constexpr \w+Step (\w+\([^()]*\));")
ONE = re.compile(rf"(\w+)(?: = ({VALUE})|(\([^()]*\)))")
PAPER = re.compile(r"[A-Z][^\W\d]+(?: et al\.| and [A-Z][^\W\d]+)?,? \(?(?:19|20)\d\d")
HEAD = """# Numbers that steer

Constants that code gives a name, but those of file formats. `bench/constants.py` makes this table, keeps the last
column, and measures: it halves and doubles a constant, and compares errors at equal CPU time. "Arbitrary" is what
neither changes.
"""


class Constant:
    def __init__(self, file, line, name, value, comment):
        self.file, self.line, self.name, self.value, self.comment = file, line, name, value, comment

    def key(self):
        return f"{self.file}: {self.name}"


def comment_of(lines, i):
    """Beside line i, or else above it."""
    beside = lines[i].partition("//")[2]
    if beside:
        return beside.lstrip("/< ").strip()
    above = []
    for line in reversed(lines[:i]):
        if not line.strip().startswith("//"):
            break
        above.insert(0, line.strip().lstrip("/ ").strip())
    return " ".join(above)


def constants():
    files = subprocess.run(["git", "-C", str(ROOT), "ls-files", "src"], check=True, capture_output=True, text=True).stdout.split()
    for file in files:
        if file.startswith(LEFT_OUT) or not file.endswith((".h", ".cpp")):
            continue
        lines = (ROOT / file).read_text().splitlines()
        for i, line in enumerate(lines):
            found = DEFINITION.match(line)
            for m in ONE.finditer(found.group(1) or found.group(2)) if found else ():
                value = (m.group(2) or m.group(3)).strip()
                if value not in ("0", "1", "-1"):
                    yield Constant(file, i, m.group(1), value, comment_of(lines, i))


def known():
    """What the table says so far of each constant's source."""
    if TABLE.exists() and not TABLE.stat().st_size:
        sys.exit(f"found an empty {TABLE.relative_to(ROOT)}, expected the table so far: write to another file, and move that")
    sources, file = {}, ""
    for line in TABLE.read_text().splitlines() if TABLE.exists() else ():
        if line.startswith("## "):
            file = line[3:].strip()
        cells = [c.strip() for c in line.strip("| ").split(" | ")]
        if line.startswith("| `") and len(cells) == 4:
            name = cells[0].strip("`")
            sources[f"{file}: {name}"] = sources[name] = cells[3]  # by its name alone where files have moved
    return sources


def table():
    sources, file = known(), ""
    print(HEAD, end="")
    for c in constants():
        if c.file != file:
            file = c.file
            print(f"\n## {file}\n\n| constant | value | steers | source or sweep |\n| --- | --- | --- | --- |")
        paper = PAPER.search(c.comment)
        kept = sources.get(c.key(), sources.get(c.name, "not measured") if len(c.name) > 6 else "not measured")
        source = paper.group(0) if paper and kept == "not measured" else kept
        print(f"| `{c.name}` | {c.value} | {c.comment.replace('|', '/')} | {source} |")


def scaled(c, factor):
    """The constant's line with its value times `factor`; steps from a range are scaled at both ends."""
    line = (ROOT / c.file).read_text().splitlines()[c.line]
    old = f"{c.name}{c.value}" if c.value.startswith("(") else f"{c.name} = {c.value}"
    if c.value.startswith("("):
        new = c.name + "(" + ", ".join(f"{factor} * ({v.strip()})" for v in c.value.strip("()").split(",")) + ")"
    else:
        # A cast keeps the type of what is an integer.
        kind = re.search(r"constexpr (?:static )?([\w:]+) ", line).group(1)
        new = f"{c.name} = static_cast<{kind}>(({c.value}) * {factor})"
    return line.replace(old, new, 1)


def build(scratch):
    done = subprocess.run(["cmake", "--build", scratch / "build", "-j2", "--target", "keyhole"], capture_output=True, text=True,
                          check=False)
    return done.returncode == 0


def relative_error(picture, reference):
    """Root of the mean squared relative error, pixels by pixels."""
    a, b = common.luminance(picture), common.luminance(reference)
    return float((((a - b) ** 2) / (b ** 2 + 0.01 * b.mean() ** 2)).mean() ** 0.5)


def errors(args, keyhole, scratch):
    """Of each scene, the median over seeds."""
    found = []
    for scene in args.scenes.split(","):
        runs = []
        for seed in range(1, args.repeats + 1):
            common.render(keyhole, str(ROOT / f"scenes/{scene}.yaml"), [f"method={args.method}", f"seed={seed}"], scratch / "a.exr",
                          "--cpu-time", str(args.seconds), "--resolution", args.resolution)
            runs.append(relative_error(scratch / "a.exr", scratch / f"{scene}.exr"))
        found.append(statistics.median(runs))
    return found


def measure(args):
    chosen = [c for c in constants() if not args.names or c.name in args.names or c.key() in args.names]
    if not chosen:
        sys.exit("no such constant")
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        shutil.copytree(ROOT, scratch / "tree", ignore=shutil.ignore_patterns("build*", ".git", "out"))
        subprocess.run(["cmake", "-S", scratch / "tree", "-B", scratch / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        "-DKEYHOLE_UNITY=ON"], check=True, capture_output=True)
        if not build(scratch):
            sys.exit("the program as it is doesn't build")
        keyhole = scratch / "build/keyhole"
        for scene in args.scenes.split(","):
            common.render(str(keyhole), str(ROOT / f"scenes/{scene}.yaml"), ["method=bdpt", "seed=99"], scratch / f"{scene}.exr",
                          "--cpu-time", str(args.reference_seconds), "--resolution", args.resolution)
        usual = errors(args, str(keyhole), scratch)
        print("| constant | error with half of it | with double |\n| --- | --- | --- |", flush=True)
        for c in chosen:
            path = scratch / "tree" / c.file
            original = path.read_text()
            ratios = []
            for factor in (0.5, 2):
                lines = original.splitlines()
                lines[c.line] = scaled(c, factor)
                path.write_text("\n".join(lines) + "\n")
                ratios.append("doesn't build" if not build(scratch) else " ".join(
                    f"{e / u:.3f}" for e, u in zip(errors(args, str(keyhole), scratch), usual)))
            path.write_text(original)
            print(f"| `{c.key()}` | {ratios[0]} | {ratios[1]} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--measure", action="store_true")
    parser.add_argument("names", nargs="*")
    parser.add_argument("--scenes", default="box,rooms,lantern")
    parser.add_argument("--method", default="mps")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--reference-seconds", type=float, default=240)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--resolution", default="96x64")
    args = parser.parse_args()
    if args.table:
        table()
    elif args.measure:
        measure(args)
    else:
        parser.error("--table or --measure")


if __name__ == "__main__":
    main()
