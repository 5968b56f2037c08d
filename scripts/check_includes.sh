#!/usr/bin/env bash
# Every source file of src compiles by itself. Builds by folder hide an include that is missing, for a file before it in
# its folder has it. Nothing is written but a folder of CMake's, build-alone.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

cmake --preset release --log-level=WARNING -B build-alone -DKEYHOLE_UNITY=OFF \
    -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >/dev/null
python3 - <<'PYTHON'
import concurrent.futures
import json
import os
import shlex
import subprocess
import sys

def check(entry):
    """What the compiler says of the file; no code is made."""
    command = shlex.split(entry["command"])
    at = command.index("-o")
    command = command[:at] + command[at + 2:] + ["-fsyntax-only", "-O0"]
    run = subprocess.run(command, cwd=entry["directory"], capture_output=True, text=True)
    return run.stderr if run.returncode else ""

entries = [e for e in json.load(open("build-alone/compile_commands.json")) if f"{os.getcwd()}/src/" in e["file"]]
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    said = [text for text in pool.map(check, entries) if text]
print("".join(said), end="")
sys.exit(1 if said or not entries else 0)
PYTHON
