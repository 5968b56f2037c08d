"""Runs the tests: blender -b --factory-startup -P run.py -- KEYHOLE [part of a test's name]

With KEYHOLE_SHARD=K/N only every Nth, from the Kth on: several Blenders can share them."""

import importlib
import os
import sys
import time
import traceback

here = os.path.dirname(os.path.abspath(__file__))
arguments = sys.argv[sys.argv.index("--") + 1:]
os.environ["KEYHOLE"] = os.path.abspath(arguments[0])
sys.path[:0] = [here, os.path.join(here, "..", "..", "blender")]

import harness  # noqa: E402  (finds the add-on by the path above)

for name in sorted(os.listdir(here)):
    if name.endswith("_test.py"):
        importlib.import_module(name[:-3])

first, count = map(int, os.environ.get("KEYHOLE_SHARD", "0/1").split("/"))
failed = []
for function in harness.TESTS[first::count]:
    name = f"{function.__module__}.{function.__name__}"
    if len(arguments) > 1 and arguments[1] not in name:
        continue
    start = time.process_time()
    try:
        harness.empty_scene()
        result = function()
        figure = f"{100 * result:.1f} %" if isinstance(result, float) else ""
        print(f"passed {name} {figure} ({time.process_time() - start:.1f} s)", flush=True)
    except Exception:  # a test may fail in any way
        failed.append(name)
        print(f"FAILED {name}\n{traceback.format_exc()}", flush=True)
sys.stdout.flush()
os._exit(1 if failed else 0)  # Blender's own exit code is 0 in any case
