"""Small scenes made by script, rendered by Cycles and by Keyhole, and how far the two are apart."""

import math
import os
import sys
import tempfile

import bpy
import numpy as np

import keyhole
from keyhole import exr

SIZE = 64, 48
BLOCK = 16  # pixels
CYCLES_SAMPLES, KEYHOLE_SAMPLES = 200, 100
TESTS = []


def test(function):
    TESTS.append(function)
    return function


def empty_scene():
    """A camera that looks at the origin from the front, and a grey sky. Every test begins with it."""
    if not hasattr(bpy.types.Scene, "keyhole"):
        keyhole.register()
    old = list(bpy.data.scenes)
    scene = bpy.data.scenes.new("Test")
    bpy.context.window.scene = scene
    for kind in ("objects", "meshes", "curves", "materials", "lights", "images", "cameras", "worlds", "collections"):
        bpy.data.batch_remove(getattr(bpy.data, kind))
    bpy.data.batch_remove(old)
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.world = bpy.data.worlds.new("World")
    sky(0.3)
    data = bpy.data.cameras.new("Camera")
    scene.camera = add("Camera", data, (0, -6, 3), (math.radians(65), 0, 0))


def sky(grey):
    bpy.context.scene.world.color = (grey,) * 3


def add(name, data, place=(0, 0, 0), turn=(0, 0, 0)):
    thing = bpy.data.objects.new(name, data)
    thing.location, thing.rotation_euler = place, turn
    bpy.context.scene.collection.objects.link(thing)
    return thing


def of_operator(operator, material=None, **options):
    operator(**options)
    thing = bpy.context.object
    if material:
        thing.data.materials.append(material)
    return thing


def floor(material=None, size=8):
    return of_operator(bpy.ops.mesh.primitive_plane_add, material or diffuse("Floor", (0.6, 0.5, 0.4)), size=size)


def ball(material=None, place=(0, 0, 1)):
    thing = of_operator(bpy.ops.mesh.primitive_uv_sphere_add, material, segments=48, ring_count=24, location=place)
    for polygon in thing.data.polygons:
        polygon.use_smooth = True
    return thing


def lamp(kind, place=(1.5, -1.5, 4), turn=(0, 0, 0), energy=400, **options):
    data = bpy.data.lights.new(kind.title(), kind)
    data.energy = energy
    for key, value in options.items():
        setattr(data, key, value)
    return add(kind.title(), data, place, turn)


class Nodes:
    """A material by its nodes: `n = Nodes("Glass")`, `n.add("ShaderNodeBsdfGlass", IOR=1.5)`."""

    def __init__(self, name):
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.output = self.tree.nodes.new("ShaderNodeOutputMaterial")

    def add(self, kind, to=None, **inputs):
        """A node, whose first output is linked to the socket `to`; the material's surface by True."""
        node = self.tree.nodes.new(kind)
        for name, value in inputs.items():
            socket = node.inputs[name.replace("_", " ")]
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            else:
                socket.default_value = value
        if to is not None:
            self.tree.links.new(node.outputs[0], self.output.inputs["Surface"] if to is True else to)
        return node


def rgba(colour):
    return (*colour, 1)


def diffuse(name, colour):
    nodes = Nodes(name)
    nodes.add("ShaderNodeBsdfDiffuse", True, Color=rgba(colour))
    return nodes.material


def render(engine, options="", samples=None, multilayer=False, method="path", denoise=False):
    """The channels of the current scene's picture. And what Keyhole's engine says."""
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.cycles.samples = samples or CYCLES_SAMPLES
    for key in ("use_adaptive_sampling", "use_denoising"):
        setattr(scene.cycles, key, False)
    for key in ("sample_clamp_indirect", "sample_clamp_direct", "blur_glossy", "light_sampling_threshold"):
        setattr(scene.cycles, key, 0)
    for key in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"):
        setattr(scene.cycles, key, 32)
    chosen = scene.keyhole
    chosen.effort, chosen.method, chosen.denoise = "QUALITY", method, denoise
    chosen.options = options or f"--spp {samples or KEYHOLE_SAMPLES}"
    settings = scene.render.image_settings
    settings.file_format = "OPEN_EXR_MULTILAYER" if multilayer else "OPEN_EXR"
    settings.color_depth, settings.exr_codec, settings.color_mode = "32", "ZIP", "RGBA"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = os.path.join(folder, "picture.exr")
        with captured() as lines:
            bpy.ops.render.render(write_still=True)
        return exr.read(scene.render.filepath), lines()


class captured:
    """What C and Python print meanwhile."""

    def __enter__(self):
        sys.stdout.flush()
        self.file, self.kept = tempfile.TemporaryFile(), os.dup(1)
        os.dup2(self.file.fileno(), 1)
        return self.lines

    def __exit__(self, *_):
        sys.stdout.flush()
        os.dup2(self.kept, 1)
        os.close(self.kept)
        self.file.seek(0)
        self.text = self.file.read().decode(errors="replace")

    def lines(self):
        return [line for line in self.text.splitlines() if line.startswith("keyhole: ")]


def blocks(channels):
    """Means of blocks, (rows, columns, 3)."""
    picture = np.stack([channels[c] for c in "RGB"], 2)
    height, width = (n // BLOCK * BLOCK for n in picture.shape[:2])
    return picture[:height, :width].reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, 3).mean((1, 3))


def differences():
    """Relative differences of blocks, Keyhole's against Cycles', and Keyhole's messages."""
    reference, _ = render("CYCLES")
    picture, messages = render("KEYHOLE")
    theirs, ours = blocks(reference), blocks(picture)
    return (ours - theirs) / np.maximum(theirs, 0.02 * theirs.mean()), messages


def agree(within=0.03, says=()):
    """Asserts that both show the same, and that Keyhole says just what is expected of it."""
    difference, messages = differences()
    worst = float(np.abs(difference).max())
    assert worst <= within, f"blocks differ by {100 * worst:.1f} %, expected {100 * within:.0f} %: {difference}"
    expect(messages, says)
    return worst


def expect(messages, says):
    """Asserts that there is one message for each piece of text, and none besides."""
    left = list(messages)
    for text in says:
        found = next((line for line in left if text in line), None)
        assert found, f"nothing is said of '{text}' in {messages}"
        left.remove(found)
    assert not left, f"found messages {left}, expected none"
