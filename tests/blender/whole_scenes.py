"""Whole scenes made by script: an interior in daylight, two rooms and a door, a glTF model."""

import math
import os

import bpy
import numpy as np

from harness import Nodes, add, ball, diffuse, lamp, of_operator, rgba, sky


def block(lower, upper, material):
    size = [b - a for a, b in zip(lower, upper)]
    middle = [(a + b) / 2 for a, b in zip(lower, upper)]
    thing = of_operator(bpy.ops.mesh.primitive_cube_add, material, size=1, location=middle)
    thing.scale = size
    return thing


def room(lower, upper, material, floor=None):
    """Floor, ceiling and walls 0.1 m thick; without the wall at the far x."""
    (x0, y0, z0), (x1, y1, z1), t = lower, upper, 0.1
    block((x0 - t, y0 - t, z0 - t), (x1 + t, y1 + t, z0), floor or material)
    block((x0 - t, y0 - t, z1), (x1 + t, y1 + t, z1 + t), material)
    block((x0 - t, y0 - t, z0), (x0, y1 + t, z1), material)
    block((x0, y0 - t, z0), (x1 + t, y0, z1), material)
    block((x0, y1, z0), (x1 + t, y1 + t, z1), material)


def wall_with_hole(x, y, z, hole_y, hole_z, material):
    """A wall at x of the extent y, z around a hole."""
    t = 0.1
    block((x, y[0], z[0]), (x + t, hole_y[0], z[1]), material)
    block((x, hole_y[1], z[0]), (x + t, y[1], z[1]), material)
    block((x, hole_y[0], hole_z[1]), (x + t, hole_y[1], z[1]), material)
    if hole_z[0] > z[0]:
        block((x, hole_y[0], z[0]), (x + t, hole_y[1], hole_z[0]), material)


def look(place, turn, lens=20):
    camera = bpy.context.scene.camera
    camera.location, camera.rotation_euler = place, [math.radians(x) for x in turn]
    camera.data.lens = lens


def pattern():
    """A picture of coloured tiles, packed."""
    pixels = np.ones((32, 32, 4), np.float32)
    y, x = np.mgrid[:32, :32] // 4
    pixels[:, :, 0], pixels[:, :, 1], pixels[:, :, 2] = 0.3 + 0.05 * x, 0.6 - 0.04 * y, 0.25 + 0.1 * ((x + y) % 2)
    image = bpy.data.images.new("Tiles", 32, 32)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image


def plastic(name, colour, roughness=0.4, **inputs):
    nodes = Nodes(name)
    nodes.add("ShaderNodeBsdfPrincipled", True, Base_Color=rgba(colour), Roughness=roughness, **inputs)
    return nodes.material


def tiled(kind, **inputs):
    nodes = Nodes("Tiles")
    shader = nodes.add(kind, True, **inputs)
    texture = nodes.add("ShaderNodeTexImage", shader.inputs[0])
    texture.image, texture.interpolation = pattern(), "Closest"
    return nodes.material


def glass():
    nodes = Nodes("Glass")
    nodes.add("ShaderNodeBsdfGlass", True, IOR=1.5).distribution = "SHARP"
    return nodes.material


def interior():
    """A room with a window; a soft sun and a sky. Plastic, glass, textures, in the shade: Cycles has no caustics."""
    white = diffuse("White", (0.75, 0.75, 0.72))
    room((0, 0, 0), (4, 5, 2.6), white, tiled("ShaderNodeBsdfDiffuse"))
    wall_with_hole(4, (0, 5), (0, 2.6), (1.8, 3.8), (0.9, 2.2), white)
    block((0.8, 3.2, 0), (1.6, 4.2, 0.75), plastic("Table", (0.5, 0.25, 0.1)))
    ball(plastic("Red", (0.7, 0.1, 0.08), 0.3), (1.0, 3.9, 0.95)).scale = (0.2,) * 3
    ball(glass(), (1.3, 3.5, 0.9)).scale = (0.15,) * 3
    tree = bpy.context.scene.world
    tree.use_nodes = True
    background = tree.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (0.5, 0.7, 1, 1), 2
    lamp("SUN", turn=(math.radians(50), 0, math.radians(110)), energy=8, angle=math.radians(4))
    look((1.6, 0.3, 1.4), (85, 0, 5))


def door(with_path=True):
    """Two rooms, a lamp in one, the eye in the other; light is led through the door by a curve."""
    sky(0)
    white = diffuse("White", (0.7, 0.7, 0.7))
    room((0, 0, 0), (6, 4, 2.6), white)
    block((6, 0, 0), (6.1, 4, 2.6), white)
    wall_with_hole(3, (0, 4), (0, 2.6), (2.6, 2.9), (0, 2.0), diffuse("Wall", (0.6, 0.45, 0.3)))
    block((4.2, 1.5, 0), (5.0, 2.4, 0.6), plastic("Chest", (0.2, 0.35, 0.6)))
    lamp("AREA", (1.5, 1.5, 2.55), size=0.6, energy=300)
    look((5.7, 0.4, 1.5), (82, 0, 35))
    if with_path:
        draw_path()


def draw_path():
    owner = bpy.data.collections.new("Keyhole Paths")
    bpy.context.scene.collection.children.link(owner)
    opening = of_operator(bpy.ops.mesh.primitive_plane_add, size=1, location=(3.05, 2.75, 1), rotation=(0, math.pi / 2, 0))
    opening.scale = 2, 0.3, 1
    data = bpy.data.curves.new("Through the door", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(2)
    for point, place in zip(spline.points, [(1.5, 1.5, 2.55), (3.05, 2.75, 1), (4.5, 3.3, 0)]):
        point.co = (*place, 1)
    curve = add("Through the door", data)
    curve["bounces"] = [1, 6]
    for thing in (opening, curve):
        for other in list(thing.users_collection):
            other.objects.unlink(thing)
        owner.objects.link(thing)
        thing.hide_render = True  # for Cycles
    bpy.context.view_layer.update()


def model():
    """A head of painted metal on a plinth under a glowing panel, and a sun."""
    sky(0)
    of_operator(bpy.ops.mesh.primitive_plane_add, tiled("ShaderNodeBsdfPrincipled", Specular=0.0), size=12)
    look((0, -4.2, 5.2), (45, 0, 0), 45)
    head = of_operator(bpy.ops.mesh.primitive_monkey_add, location=(0, 0, 1.2))
    for polygon in head.data.polygons:
        polygon.use_smooth = True
    nodes = Nodes("Paint")
    nodes.add("ShaderNodeBsdfPrincipled", True, Base_Color=rgba((0.9, 0.5, 0.2)), Metallic=0.5, Roughness=0.5)
    head.data.materials.append(nodes.material)
    block((-0.7, -0.7, 0), (0.7, 0.7, 0.6), plastic("Plinth", (0.4, 0.45, 0.5), 0.6))
    panel = Nodes("Panel")
    panel.add("ShaderNodeBsdfPrincipled", True, Base_Color=rgba((0, 0, 0)), Specular=0.0, Emission=rgba((1, 0.9, 0.8)),
              Emission_Strength=6.0)
    of_operator(bpy.ops.mesh.primitive_plane_add, panel.material, size=2, location=(-2, -1, 4))
    lamp("SUN", turn=(0.6, 0.3, 0.2), energy=1.5, angle=0)


def through_gltf(folder):
    """The scene as it is in a file that Blender wrote: that of Blender is made anew from it. Returns the file."""
    file = os.path.join(folder, "scene.glb")
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.export_scene.gltf(filepath=file, export_format="GLB", export_cameras=True, export_lights=True)
    return file
