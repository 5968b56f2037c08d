#!/usr/bin/env python3
"""Words that this project once made up for things that have a name: none of them in what is tracked. And prose wraps.

scripts/check_words.py [DIRECTORY...] prints PATH:LINE: WORD, the field's word, and the line, and lines of prose that are
wider than 120 characters; exits with 1 if there are any.
Identifiers are read as words: `photonScout`, `photon_scout` and `PhotonScout` all have a scout."""
import pathlib
import re
import subprocess
import sys

FOLDERS = ("src", "docs", "bench", "scenes", "scripts", "tests", "README.md", "CONTRIBUTING.md")
SUFFIXES = (".h", ".cpp", ".md", ".py", ".sh", ".yaml", ".txt", ".js", ".html", ".css")

# What is not to be found, and what it is called. Word borders are those of identifiers, too.
WORDS = {
    r"scouts?|scouted|scouting": "pilot photon",
    r"carriers?": "photon, main photon",
    r"witness(es)?": "visibility probe",
    r"joints?": "connection",
    r"crews?": "communicator",
    r"pulses?": "heartbeat",
    r"parcels?": "message",
    r"keepings?": "checkpoint",
    r"foresees?|foreseen|foretells?|foretold": "cost model, predict",
    r"drawn light": "splatted light",
    r"pixel words?": "accumulator state",
    r"bright spots?": "hot spots, guiding directions",
    r"eye sides?": "camera sub-path",
    r"beyond (the |their )?reach": "outside gather coverage",
    r"second tr(y|ies)": "delayed rejection",
    r"longest stays?": "longest rejection run",
    r"technique changes?": "reversible jump",
    r"place grid": "surface lookup grid",
    r"sites|site light": "direct irradiance cache, precomputation points",
    r"retraces?|retraced|retracing": "specular chain retracing",
    r"(first|second|third|last|of a|a) stretch(es)?( of (a|the|its) chains?)?": "batch, burn-in",
}

# Ordinary English, other people's names, and old words that are still read.
ALLOWED = (
    r"web ?sites?|on-site|site-packages",
    r"joint (density|distribution|probability|bilateral)",
    r"jointly|disjoint",
    r"carrier (of|frequency)",
    r"(has|one|were) bright spots?",  # fireflies, and what a picture shows
    r"deprecated|old (name|key|word)|once called|formerly",
    r"specular chain retracing|retrace specular chain|perturbations that retrace",
)

WORD = re.compile("|".join(f"(?P<w{i}>\\b(?:{w})\\b)" for i, w in enumerate(WORDS)), re.I)
NAMES = list(WORDS.values())
WIDEST = 120
SPLIT = re.compile(r"_|(?<=[a-z0-9])(?=[A-Z])")
EXCEPT = re.compile("|".join(ALLOWED), re.I)


def found(line):
    """Home-made words of a line with the field's for them."""
    plain = SPLIT.sub(" ", line)
    if EXCEPT.search(plain):
        return []
    return [(m.group(0), NAMES[int(m.lastgroup[1:])]) for m in WORD.finditer(plain)]


def too_wide(lines):
    """Numbers of prose lines that don't wrap; tables, code and links can't."""
    code = False
    for number, line in enumerate(lines, 1):
        if line.lstrip().startswith("```"):
            code = not code
        if len(line) > WIDEST and not code and not line.startswith(("|", "    ", "![")) and "http" not in line:
            yield number


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    tracked = subprocess.run(["git", "-C", str(root), "ls-files", "-z", "--", *(sys.argv[1:] or FOLDERS)],
                             check=True, capture_output=True, text=True).stdout.split("\0")
    wrong = 0
    for path in tracked:
        if not path.endswith(SUFFIXES) or path == "scripts/check_words.py" or not (root / path).is_file():
            continue
        lines = (root / path).read_text(errors="replace").splitlines()
        for number in too_wide(lines) if path.endswith(".md") else ():
            print(f"{path}:{number}: wider than {WIDEST} characters")
            wrong += 1
        for number, line in enumerate(lines, 1):
            for word, name in found(line):
                print(f"{path}:{number}: {word} ({name}): {line.strip()[:120]}")
                wrong += 1
    print(f"{wrong} home-made words and wide lines" if wrong else "no home-made words, no wide lines")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main())
