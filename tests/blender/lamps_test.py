"""Each kind of lamp, and the world."""

import math
import os
import tempfile

import bpy
import numpy as np

from harness import Nodes, add, agree, ball, floor, lamp, of_operator, rgba, sky, test

TILTED = 0.5, 0.4, 0.3


def lit_by(kind, within=0.03, grey=0, **options):
    """Where the lamp leaves much in the dark, a grey sky keeps noise low there."""
    sky(grey)
    floor()
    ball()
    lamp(kind, color=(1, 0.8, 0.5), **options)
    return agree(within)


@test
def point_lamp():
    return lit_by("POINT", shadow_soft_size=0)


@test
def point_lamp_with_radius():
    return lit_by("POINT", shadow_soft_size=0.4)


@test
def area_lamp_square():
    return lit_by("AREA", size=1, turn=TILTED)


@test
def area_lamp_rectangle():
    return lit_by("AREA", shape="RECTANGLE", size=2, size_y=0.5, turn=TILTED)


@test
def area_lamp_disk():
    return lit_by("AREA", shape="DISK", size=2, turn=TILTED)


@test
def area_lamp_ellipse():
    return lit_by("AREA", shape="ELLIPSE", size=2, size_y=0.7, turn=TILTED)


@test
def area_lamp_with_spread():
    return lit_by("AREA", grey=0.3, size=1, spread=1.0, turn=TILTED)


@test
def area_lamp_disk_with_narrow_spread():
    """With 40 times the samples they differ by 0.5 %: Cycles draws most of its samples in the dark."""
    return lit_by("AREA", within=0.06, grey=0.3, shape="DISK", size=2, spread=0.5, energy=60)


@test
def spot_lamp():
    """Cycles dims the cone by the cosine, which is 0.9 at its edge."""
    return lit_by("SPOT", within=0.06, shadow_soft_size=0, spot_size=0.9, spot_blend=0.5, turn=TILTED)


@test
def spot_lamp_with_radius():
    return lit_by("SPOT", grey=0.05, shadow_soft_size=0.3, spot_size=1.1, spot_blend=0.5, turn=TILTED)


@test
def wide_spot_lamp_with_radius():
    return lit_by("SPOT", shadow_soft_size=0.1, spot_size=2.4, spot_blend=0.15)


@test
def sun_lamp():
    return lit_by("SUN", angle=0, energy=3, turn=TILTED)


@test
def sun_lamp_with_disc():
    return lit_by("SUN", angle=math.radians(10), energy=3, turn=TILTED)


@test
def lamp_with_nodes():
    data = lamp("POINT", shadow_soft_size=0.4).data
    data.use_nodes = True
    node = data.node_tree.nodes["Emission"]
    node.inputs["Strength"].default_value, node.inputs["Color"].default_value = 1.5, (0.3, 0.6, 0.9, 1)
    sky(0)
    floor()
    return agree()


@test
def emitting_mesh():
    nodes = Nodes("Lamp")
    nodes.add("ShaderNodeEmission", True, Color=rgba((1, 0.7, 0.4)), Strength=8)
    sky(0)
    floor()
    of_operator(bpy.ops.mesh.primitive_plane_add, nodes.material, size=1, location=(0, 0, 2.5))
    return agree()


def world_nodes(color, strength=1):
    world = bpy.context.scene.world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = color, strength
    return world.node_tree, background


@test
def world_colour():
    world_nodes((0.2, 0.5, 0.8, 1), 0.7)
    floor()
    ball()
    return agree()


@test
def world_picture_turned():
    """A bright patch at one side and another above the other side, seen by their light on the floor."""
    tree, background = world_nodes((1, 1, 1, 1), 0.5)
    importance = bpy.context.scene.world.cycles
    importance.sampling_method, importance.sample_map_resolution = "MANUAL", 64
    pixels = np.full((32, 64, 4), 0.2, np.float32)
    pixels[20:26, 5:15] = 6, 1, 0.5, 1
    pixels[18:22, 40:46] = 0.5, 1, 9, 1
    image = bpy.data.images.new("Sky", 64, 32, float_buffer=True)
    with tempfile.TemporaryDirectory() as folder:
        image.pixels.foreach_set(pixels.ravel())
        image.filepath_raw, image.file_format = os.path.join(folder, "sky.exr"), "OPEN_EXR"
        image.save()
        texture = tree.nodes.new("ShaderNodeTexEnvironment")
        texture.image, texture.interpolation = bpy.data.images.load(image.filepath_raw), "Closest"
        mapping = tree.nodes.new("ShaderNodeMapping")
        mapping.inputs["Rotation"].default_value = 0.2, 0.3, 0.8
        tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
        tree.links.new(texture.outputs["Color"], background.inputs["Color"])
        floor()
        ball()
        return agree()


@test
def lamp_in_an_instance():
    """Lamps and meshes that a collection's instance brings along."""
    collection = bpy.data.collections.new("Lit")
    for thing in (lamp("AREA", (0, 0, 3), size=1), ball(place=(0, 0, 0.5))):
        bpy.context.scene.collection.objects.unlink(thing)
        collection.objects.link(thing)
    floor()
    for x in (-1.5, 1.5):
        instance = add(f"Instance {x}", None, (x, 0, 0), (0, 0.3, 0))
        instance.instance_type, instance.instance_collection = "COLLECTION", collection
    return agree()
