"""Errors of Cycles and Keyhole after the same time on one core, by hand:

blender -b --factory-startup -P time_study.py -- KEYHOLE [SECONDS [SCENE...]]

Each renders twice with half of SECONDS (120) and two seeds. Half the difference of the two pictures is the noise of
their mean: its root mean square, relative to brightness. What both have in common shows in means of blocks.
"""

import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "..", "..", "blender")]
arguments = sys.argv[sys.argv.index("--") + 1:]
os.environ["KEYHOLE"] = os.path.abspath(arguments[0])

import bpy  # noqa: E402  (and what follows, by the path above)
import numpy as np  # noqa: E402

import harness  # noqa: E402
import whole_scenes  # noqa: E402

SIZE = 160, 120
SECONDS = float(arguments[1]) if len(arguments) > 1 else 120


def render(engine, seed):
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.cycles.time_limit, scene.cycles.seed, scene.keyhole.seed = SECONDS / 2, seed, seed
    options = f"--timeout {SECONDS / 2} -t 1" if engine == "KEYHOLE" else ""
    picture, messages = harness.render(engine, options, samples=1 << 20, method="auto")
    for line in messages:
        print(line)
    return np.stack([picture[c] for c in "RGB"], 2)


def study(name):
    harness.empty_scene()
    getattr(whole_scenes, name)()
    means = {}
    for engine in ("CYCLES", "KEYHOLE"):
        a, b = render(engine, 1), render(engine, 2)
        mean = (a + b) / 2
        error = ((a - b) / 2) ** 2 / (mean ** 2 + 0.01 * mean.mean() ** 2)
        means[engine] = harness.blocks(dict(zip("RGB", mean.transpose(2, 0, 1))))
        print(f"{name} {engine}: {100 * np.sqrt(error.mean()):.2f} %; without the worst hundredth of the pixels "
              f"{100 * np.sqrt(np.sort(error.mean(2).ravel())[:-error[:, :, 0].size // 100].mean()):.2f} %", flush=True)
    theirs, ours = means["CYCLES"], means["KEYHOLE"]
    difference = np.abs(ours - theirs) / np.maximum(theirs, 0.02 * theirs.mean())
    print(f"{name}: blocks differ by {100 * difference.mean():.2f} % on average, at most {100 * difference.max():.1f} %",
          flush=True)


for scene_name in arguments[2:] or ("interior", "door", "model"):
    study(scene_name)
os._exit(0)
