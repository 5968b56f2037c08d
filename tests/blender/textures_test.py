"""Nodes of colours, pictures and normals."""

import bpy
import numpy as np

from harness import Nodes, agree, diffuse, floor, lamp, rgba, sky, test
from materials_test import ORANGE, scene_with


def picture(size=256, packed=False, space="sRGB"):
    """Smooth, for Cycles blends pixels before it makes them linear; no two of its sides alike."""
    image = bpy.data.images.new("Picture", size, size)
    image.colorspace_settings.name = space
    v, u = np.mgrid[0:1:size * 1j, 0:1:size * 1j]
    colours = 0.2 + 0.6 * u, 0.9 - 0.5 * v, 0.5 + 0.3 * np.cos(7 * u) * np.sin(5 * v), 0.3 + 0.7 * u
    image.pixels.foreach_set(np.stack(colours, 2).astype(np.float32).ravel())
    if packed:
        image.pack()
    image.update()
    return image


def textured(setup, kind="ShaderNodeTexImage", socket="Color", shader="ShaderNodeBsdfDiffuse", within=0.03):
    nodes = Nodes("Textured")
    bsdf = nodes.add(shader, True)
    texture = nodes.add(kind, bsdf.inputs[socket])
    setup(nodes, texture)
    scene_with(nodes.material, on_floor=True)
    return agree(within)


@test
def image_node_painted():
    return textured(lambda nodes, texture: setattr(texture, "image", picture()))


@test
def image_node_packed_linear_closest():
    def setup(_nodes, texture):
        texture.image, texture.interpolation = picture(packed=True, space="Non-Color"), "Closest"
    return textured(setup)


@test
def mapping_node():
    def setup(nodes, texture):
        texture.image = picture()
        mapping = nodes.add("ShaderNodeMapping", texture.inputs["Vector"], Location=(0.1, 0.3, 0), Scale=(2, 3, 1),
                            Rotation=(0, 0, 0.5))
        nodes.tree.links.new(nodes.add("ShaderNodeTexCoord").outputs["UV"], mapping.inputs["Vector"])
    return textured(setup, within=0.035)  # edges of sRGB pixels, seen large: 2.9 % is no noise


@test
def checker_node():
    def setup(nodes, texture):
        texture.inputs["Scale"].default_value = 4
        texture.inputs["Color1"].default_value, texture.inputs["Color2"].default_value = rgba(ORANGE), (0, 0.1, 0.3, 1)
        nodes.tree.links.new(nodes.add("ShaderNodeTexCoord").outputs["UV"], texture.inputs["Vector"])
    return textured(setup, "ShaderNodeTexChecker")


@test
def rgb_node():
    def setup(_nodes, texture):
        texture.outputs[0].default_value = rgba(ORANGE)
    return textured(setup, "ShaderNodeRGB")


@test
def mix_of_colours():
    def setup(nodes, mix):
        mix.inputs["Fac"].default_value, mix.inputs["Color2"].default_value = 0.3, rgba(ORANGE)
        nodes.add("ShaderNodeTexImage", mix.inputs["Color1"]).image = picture()
    return textured(setup, "ShaderNodeMixRGB")


def leaf(clear, opaque):
    """A mix by the alpha of a picture; `clear` and `opaque` are the numbers of its sockets."""
    nodes = Nodes("Leaf")
    mix = nodes.add("ShaderNodeMixShader", True)
    nodes.add("ShaderNodeBsdfTransparent", mix.inputs[clear])
    nodes.add("ShaderNodeBsdfDiffuse", mix.inputs[opaque], Color=rgba(ORANGE))
    texture = nodes.add("ShaderNodeTexImage")
    texture.image = picture(packed=True)
    nodes.tree.links.new(texture.outputs["Alpha"], mix.inputs["Fac"])
    scene_with(nodes.material, on_floor=True)
    return agree()


@test
def alpha_of_an_image():
    return leaf(1, 2)


@test
def alpha_of_an_image_the_other_way_round():
    return leaf(2, 1)


@test
def normal_map_node():
    nodes = Nodes("Normals")
    bsdf = nodes.add("ShaderNodeBsdfDiffuse", True, Color=rgba((0.8, 0.8, 0.8)))
    relief = nodes.add("ShaderNodeNormalMap", bsdf.inputs["Normal"])
    image = bpy.data.images.new("Normals", 4, 4)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(np.tile(np.array([0.6, 0.55, 0.95, 1], np.float32), 16))
    image.update()
    nodes.add("ShaderNodeTexImage", relief.inputs["Color"]).image = image
    sky(0)
    floor(nodes.material)
    lamp("SUN", turn=(0.6, 0.3, 0), energy=2)
    return agree()


@test
def bump_node():
    """A ramp of height is a plane that is tilted for shading."""
    nodes = Nodes("Ramp")
    bsdf = nodes.add("ShaderNodeBsdfDiffuse", True, Color=rgba((0.8, 0.8, 0.8)))
    relief = nodes.add("ShaderNodeBump", bsdf.inputs["Normal"], Distance=2.0)
    image = bpy.data.images.new("Ramp", 64, 1, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    ramp = np.ones((64, 4), np.float32)
    ramp[:, :3] = ((np.arange(64) + 0.5) / 64)[:, None]
    image.pixels.foreach_set(ramp.ravel())
    texture = nodes.add("ShaderNodeTexImage", relief.inputs["Height"])
    texture.image, texture.extension = image, "EXTEND"
    sky(0)
    floor(nodes.material)
    lamp("SUN", turn=(0.6, 0.3, 0), energy=2)
    return agree()


@test
def material_without_nodes():
    material = diffuse("Plain", ORANGE)
    material.use_nodes, material.diffuse_color = False, rgba((0.1, 0.4, 0.7))
    scene_with(material)
    return agree()
