"""Blender's own glTF files, rendered by `keyhole render x.glb`, against what the add-on exports."""

import os
import subprocess
import tempfile

import bpy
import numpy as np

from harness import Nodes, ball, blocks, floor, lamp, render, rgba, sky, test
from keyhole import exr
from textures_test import picture


def principled(name, **inputs):
    nodes = Nodes(name)
    return nodes, nodes.add("ShaderNodeBsdfPrincipled", True, **inputs)


def agrees(ending="glb"):
    """Without gloss on the base, which the add-on brightens to what it is in Cycles."""
    sky(0)
    reference, _ = render("KEYHOLE")
    with tempfile.TemporaryDirectory() as folder:
        scene, output = (os.path.join(folder, name) for name in ("scene." + ending, "picture.exr"))
        bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
        kind = "GLB" if ending == "glb" else "GLTF_SEPARATE"
        bpy.ops.export_scene.gltf(filepath=scene, export_format=kind, export_cameras=True, export_lights=True)
        done = subprocess.run([os.environ["KEYHOLE"], "render", scene, "-o", output, "--no-png", "--resolution", "64x48",
                               "--method", "path", "--spp", "100"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        picture = exr.read(output)
    theirs, ours = blocks(reference), blocks(picture)
    worst = float(np.abs((ours - theirs) / np.maximum(theirs, 0.02 * theirs.mean())).max())
    assert worst < 0.03, f"blocks differ by {100 * worst:.1f} %"
    return worst


def textured_floor():
    nodes, bsdf = principled("Floor", Roughness=0.7, Specular=0.0)
    texture = nodes.add("ShaderNodeTexImage", bsdf.inputs["Base Color"])
    texture.image = picture(packed=True)
    texture.image.alpha_mode = "NONE"  # in glTF opaque materials have no use for it
    mapping = nodes.add("ShaderNodeMapping", texture.inputs["Vector"], Location=(0.1, 0.3, 0), Scale=(2, 3, 1),
                        Rotation=(0, 0, 0.5))
    nodes.tree.links.new(nodes.add("ShaderNodeTexCoord").outputs["UV"], mapping.inputs["Vector"])
    floor(nodes.material)


@test
def sun_metal_and_textures():
    textured_floor()
    ball(principled("Metal", Metallic=1.0, Roughness=0.4, Base_Color=rgba((0.9, 0.6, 0.3)))[0].material)
    lamp("SUN", turn=(0.5, 0.4, 0.3), energy=3, angle=0)
    return agrees()


@test
def point_lamp_and_emission_in_separate_files():
    textured_floor()
    nodes, _ = principled("Lamp", Emission=rgba((1, 0.5, 0.2)), Emission_Strength=5.0, Specular=0.0)
    ball(nodes.material, (0, 0, 0.6)).scale = (0.3,) * 3
    lamp("POINT", shadow_soft_size=0)
    return agrees("gltf")
