"""Meshes with modifiers, several materials, instances, other geometry; what isn't exported is said."""

import time

import bpy

import keyhole.export.scene
from harness import Nodes, add, agree, ball, diffuse, empty_scene, expect, floor, lamp, of_operator, render, rgba, test


def lit_floor():
    floor()
    lamp("AREA", size=2, turn=(0.3, 0.3, 0))


@test
def modifiers_and_flat_faces():
    lit_floor()
    cube = of_operator(bpy.ops.mesh.primitive_cube_add, diffuse("Box", (0.2, 0.5, 0.8)), location=(0, 0, 1))
    cube.modifiers.new("Bevel", "BEVEL").width = 0.3
    cube.modifiers.new("Array", "ARRAY").count = 2
    cube.scale = 0.6, 0.8, -0.7
    return agree()


@test
def several_materials():
    lit_floor()
    cube = of_operator(bpy.ops.mesh.primitive_cube_add, diffuse("Blue", (0.1, 0.2, 0.9)), location=(0, 0, 1))
    cube.data.materials.append(diffuse("Red", (0.9, 0.2, 0.1)))
    for polygon in cube.data.polygons:
        polygon.material_index = polygon.index % 2
    return agree()


@test
def instances_of_collections_and_shared_meshes():
    lit_floor()
    collection = bpy.data.collections.new("Pair")
    for x in (-0.4, 0.4):
        thing = ball(diffuse(f"Ball {x}", (0.5 + x, 0.4, 0.5 - x)), (x, 0, 0.3))
        thing.scale = (0.3,) * 3
        bpy.context.scene.collection.objects.unlink(thing)
        collection.objects.link(thing)
    for x in (-1.5, 0, 1.5):
        instance = add(f"Instance {x}", None, (x, 0, 0), (0, 0, x))
        instance.instance_type, instance.instance_collection = "COLLECTION", collection
    shared = of_operator(bpy.ops.mesh.primitive_cone_add, diffuse("Cone", (0.2, 0.7, 0.3)), location=(-1, -1.5, 0))
    shared.scale = (0.3,) * 3
    other = add("Other cone", shared.data, (1, -1.5, 0))
    other.scale = 0.2, 0.4, 0.5
    return agree()


@test
def same_mesh_with_other_material():
    """Materials that belong to the object, not to the mesh that objects share."""
    lit_floor()
    first = ball(diffuse("One", (0.9, 0.1, 0.1)), (-1, 0, 0.8))
    second = add("Second", first.data, (1, 0, 0.8))
    second.material_slots[0].link = "OBJECT"
    second.material_slots[0].material = diffuse("Two", (0.1, 0.1, 0.9))
    return agree()


@test
def text_and_curves():
    lit_floor()
    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.extrude, text.size = "KEY", 0.2, 1.8
    add("Text", text, (-1.8, 0, 0.2), (1.2, 0, 0))
    return agree()


@test
def other_uv_maps_are_reported():
    nodes = Nodes("Mapped")
    texture = nodes.add("ShaderNodeTexChecker", nodes.add("ShaderNodeBsdfDiffuse", True).inputs["Color"])
    nodes.add("ShaderNodeUVMap", texture.inputs["Vector"]).uv_map = "Second"
    floor(nodes.material).data.uv_layers.new(name="Second")
    expect(render("KEYHOLE", samples=1)[1], ['the UV map "Second" is not exported: it is "UVMap"'])


@test
def unsupported_things_are_reported_and_the_rest_is_rendered():
    lit_floor()
    nodes = Nodes("Odd")
    mix = nodes.add("ShaderNodeMixShader", True)
    nodes.add("ShaderNodeBsdfHair", mix.inputs[1])
    nodes.add("ShaderNodeTexNoise", nodes.add("ShaderNodeBsdfDiffuse", mix.inputs[2]).inputs["Color"])
    nodes.add("ShaderNodeVolumeScatter", nodes.output.inputs["Volume"])
    thing = ball(nodes.material)
    thing.visible_glossy = False
    thing.modifiers.new("Hair", "PARTICLE_SYSTEM").particle_system.settings.type = "HAIR"
    add("Fog", bpy.data.volumes.new("Fog"))
    missing = Nodes("Missing")
    bsdf = missing.add("ShaderNodeBsdfPrincipled", True, Subsurface=0.5, Base_Color=rgba((0.2, 0.3, 0.4)))
    image = bpy.data.images.new("Lost", 4, 4)
    image.source, image.filepath = "FILE", "/nowhere/lost.png"
    missing.add("ShaderNodeTexImage", bsdf.inputs["Base Color"]).image = image
    thing = ball(missing.material, (1, 0, 0.5))
    tree = bpy.context.scene.world
    tree.use_nodes = True
    tree.node_tree.links.new(tree.node_tree.nodes.new("ShaderNodeTexSky").outputs[0],
                             tree.node_tree.nodes["Background"].inputs["Color"])
    picture, messages = render("KEYHOLE", samples=4)
    expect(messages, ["Odd, Hair BSDF: a shader", "Odd, Noise Texture: a node", 'Odd, Diffuse BSDF: "Color"',
                      'Odd, Material Output: "Volume"', "Sphere: it is not hidden from rays (glossy)",
                      'Sphere: hair "Hair"', "Fog: an object of type VOLUME", 'Missing, Principled BSDF: "Subsurface"',
                      "Missing, Image Texture: found no file", 'Missing, Principled BSDF: "Base Color"',
                      "World, Sky Texture: is not exported"])
    assert picture["R"].min() > 0


@test
def a_hundred_thousand_triangles_in_a_second():
    """A bound far off: the export takes 0.1 s; a loop over corners in Python would take 3 s."""
    of_operator(bpy.ops.mesh.primitive_grid_add, x_subdivisions=224, y_subdivisions=224)
    start = time.process_time()
    keyhole.export.scene.export(bpy.context.evaluated_depsgraph_get(), bpy.app.tempdir)
    assert time.process_time() - start < 1
    empty_scene()
