"""Whole scenes by Cycles and by Keyhole, and as glTF files."""

import os
import subprocess
import tempfile

import numpy as np

import whole_scenes
from harness import blocks, empty_scene, render, test
from keyhole import exr

WITHIN = 0.05


def close(a, b):
    worst = float(np.abs((b - a) / np.maximum(a, 0.02 * a.mean())).max())
    assert worst < WITHIN, f"blocks differ by {100 * worst:.1f} %"
    return worst


def compare(cycles, options, method):
    reference, _ = render("CYCLES", samples=cycles)
    picture, messages = render("KEYHOLE", options, method=method)
    assert not [line for line in messages if "warning: light" not in line], messages
    return close(blocks(reference), blocks(picture))


@test
def interior():
    whole_scenes.interior()
    return compare(1200, "--spp 250", "path")


@test
def door_with_a_path():
    whole_scenes.door()
    return compare(2000, "--spp 24 -D light_paths=400k", "ipm")


@test
def model_of_gltf():
    whole_scenes.model()
    return compare(400, "--spp 300", "path")


@test
def blenders_own_files_are_rendered():
    for make in (whole_scenes.interior, whole_scenes.door, whole_scenes.model):
        empty_scene()
        make()
        with tempfile.TemporaryDirectory() as folder:
            file, output = whole_scenes.through_gltf(folder), os.path.join(folder, "picture.exr")
            done = subprocess.run([os.environ["KEYHOLE"], "render", file, "-o", output, "--no-png", "--method", "path",
                                   "--resolution", "64x48", "--spp", "4"], capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            # The door's lamp has an area, which glTF has no word for.
            assert (exr.read(output)["R"].mean() > 0) == (make is not whole_scenes.door)
