"""Errors of Cycles and Keyhole after the same time on one core, by hand:

blender -b --factory-startup -P time_study.py -- KEYHOLE [SECONDS [SCENE...]]

Each renders twice with half of SECONDS (120) and two seeds. Half the difference of the two pictures is the noise of
their mean: its root mean square, relative to brightness. What both have in common shows in means of blocks. Cycles goes
by the clock; where the machine has other work its error is scaled to the CPU time, as the root of it.
"""

import os
import subprocess
import sys
import tempfile
import time

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "..", "..", "blender")]
arguments = sys.argv[sys.argv.index("--") + 1:]
os.environ["KEYHOLE"] = os.path.abspath(arguments[0])

import bpy  # noqa: E402  (and what follows, by the path above)
import numpy as np  # noqa: E402

import harness  # noqa: E402
import whole_scenes  # noqa: E402
from keyhole import exr  # noqa: E402
from keyhole.export.scene import export  # noqa: E402

SIZE = 160, 120
SECONDS = float(arguments[1]) if len(arguments) > 1 else 120


def by_cycles(seed):
    """Its picture, and the CPU time that it took [s]."""
    scene = bpy.context.scene
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.cycles.time_limit, scene.cycles.seed = SECONDS / 2, seed
    start = time.process_time()
    picture, _ = harness.render("CYCLES", samples=1 << 20)
    return picture, time.process_time() - start


def by_keyhole(seed):
    with tempfile.TemporaryDirectory() as folder:
        exported, output = export(bpy.context.evaluated_depsgraph_get(), folder), os.path.join(folder, "picture.exr")
        command = [os.environ["KEYHOLE"], "render", exported.path, "-o", output, "--no-png", "-q", "-t", "1",
                   "--cpu-time", str(SECONDS / 2), "--seed", str(seed)]
        if exported.user_paths:
            command += ["--user-paths", exported.user_paths]
        subprocess.run(command, check=True)
        return exr.read(output), SECONDS / 2


def render(engine, seed):
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    picture, used = by_cycles(seed) if engine == "CYCLES" else by_keyhole(seed)
    return np.stack([picture[c] for c in "RGB"], 2), used


def study(name):
    harness.empty_scene()
    getattr(whole_scenes, name)()
    means = {}
    for engine in ("CYCLES", "KEYHOLE"):
        (a, of_a), (b, of_b) = render(engine, 1), render(engine, 2)
        share = (of_a + of_b) / SECONDS
        mean = (a + b) / 2
        error = share * ((a - b) / 2) ** 2 / (mean ** 2 + 0.01 * mean.mean() ** 2)
        means[engine] = harness.blocks(dict(zip("RGB", mean.transpose(2, 0, 1))))
        print(f"{name} {engine}, {of_a + of_b:.0f} s of CPU time: {100 * np.sqrt(error.mean()):.2f} %; without the worst hundredth of the pixels "
              f"{100 * np.sqrt(np.sort(error.mean(2).ravel())[:-error[:, :, 0].size // 100].mean()):.2f} %", flush=True)
    theirs, ours = means["CYCLES"], means["KEYHOLE"]
    difference = np.abs(ours - theirs) / np.maximum(theirs, 0.02 * theirs.mean())
    print(f"{name}: blocks differ by {100 * difference.mean():.2f} % on average, at most {100 * difference.max():.1f} %",
          flush=True)


for scene_name in arguments[2:] or ("interior", "door", "model"):
    study(scene_name)
os._exit(0)
