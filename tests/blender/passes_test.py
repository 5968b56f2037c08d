"""Passes: what they show, in Blender's own files and in those of the command line."""

import os

import bpy
import numpy as np

from harness import ball, diffuse, expect, floor, lamp, render, test
from keyhole import engine, exr, process


@test
def passes_add_up():
    floor()
    ball()
    lamp("AREA", size=2)
    bpy.context.scene.keyhole.noise_passes = True
    layers, messages = render("KEYHOLE", multilayer=True, denoise=True)
    expect(messages, [])
    names = {name.split(".")[-2] for name in layers}
    assert names >= {"Combined", "Depth", "Normal", "Albedo", "Direct", "Indirect", "Caustics"}, names
    layer = next(name for name in layers if name.endswith("Combined.R")).rsplit(".", 2)[0]
    of = {name[len(layer) + 1:]: values for name, values in layers.items()}
    total = of["Direct.R"] + of["Indirect.R"] + of["Caustics.R"]
    assert np.allclose(total, of["Unfiltered.R"], rtol=1e-3, atol=1e-4)
    rough, smooth = (abs(np.diff(of[name])).mean() for name in ("Unfiltered.R", "Combined.R"))
    assert smooth < 0.9 * rough, (smooth, rough)
    assert abs(of["Combined.R"].mean() / total.mean() - 1) < 0.01
    for name, channel in (("Direct", "R"), ("Indirect", "R"), ("Normal", "Z"), ("Depth", "Z")):
        noise = abs(of[f"Noise {name}.{channel}"]).mean() / abs(of[f"{name}.{channel}"]).mean()
        assert 0.0001 < noise < 0.5, (name, noise)
    middle = of["Normal.Z"].shape[0] - 4, of["Normal.Z"].shape[1] // 2
    assert of["Normal.Z"][middle] > 0.99, "the floor, at the bottom, looks up"
    assert 3 < of["Depth.Z"][middle] < 6
    assert abs(of["Albedo.R"][middle] - 0.6) < 0.01


@test
def nothing_is_filtered_where_nobody_asks():
    floor()
    lamp("AREA", size=2)
    layers, _ = render("KEYHOLE", multilayer=True)
    of = {".".join(name.split(".")[-2:]): values for name, values in layers.items()}
    assert "Unfiltered.R" not in of and "Noise Direct.R" not in of
    assert np.allclose(of["Direct.R"] + of["Indirect.R"] + of["Caustics.R"], of["Combined.R"], rtol=1e-3, atol=1e-4)


@test
def each_view_layer_has_its_picture():
    floor()
    collection = bpy.data.collections.new("Lamps")
    bpy.context.scene.collection.children.link(collection)
    thing = lamp("AREA", size=2)
    bpy.context.scene.collection.objects.unlink(thing)
    collection.objects.link(thing)
    dark = bpy.context.scene.view_layers.new("Dark")
    dark.layer_collection.children["Lamps"].exclude = True
    layers, _ = render("KEYHOLE", multilayer=True, samples=8)
    first = bpy.context.scene.view_layers[0].name
    assert layers["Dark.Combined.R"].mean() < 0.8 * layers[first + ".Combined.R"].mean() > 0


@test
def blender_reads_the_passes_of_a_file_from_the_command_line():
    floor()
    exported = engine.scene_export.export(bpy.context.evaluated_depsgraph_get(), bpy.app.tempdir)
    picture = os.path.join(bpy.app.tempdir, "layers.exr")
    assert process.Run([os.environ["KEYHOLE"], "render", exported.path, "-o", picture, "--no-png", "--method", "path",
                        "--spp", "1"]).finish() == 0
    scene = bpy.context.scene
    scene.use_nodes = True
    node = scene.node_tree.nodes.new("CompositorNodeImage")
    node.image = bpy.data.images.load(picture)
    assert node.image.type == "MULTILAYER", node.image.type
    names = {output.name for output in node.outputs}
    assert names >= {"Combined", "albedo", "caustic", "depth", "direct", "indirect", "normal"}, names


def of_kind(layers, name):
    """(height, width, 4): the channels of a pass."""
    return np.stack([next(v for k, v in layers.items() if k.endswith(f"{name}.{c}")) for c in "rgba"], 2)


@test
def cryptomatte_is_that_of_cycles():
    floor(diffuse("Sand & \"gold\"", (0.6, 0.5, 0.4)))
    ball(diffuse("Clay", (0.5, 0.5, 0.5)))
    lamp("AREA", size=2)
    layer = bpy.context.scene.view_layers[0]
    layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_material = True
    theirs, _ = render("CYCLES", multilayer=True, samples=64)
    ours, messages = render("KEYHOLE", multilayer=True, samples=1)
    expect(messages, [])
    for kind in ("CryptoObject00", "CryptoMaterial00"):
        a, b = of_kind(theirs, kind), of_kind(ours, kind)
        ids = [np.ascontiguousarray(x[:, :, 0]).view(np.uint32) for x in (a, b)]
        clear = (a[:, :, 1] > 0.7) & (b[:, :, 1] > 0.7)
        assert clear.mean() > 0.5
        assert (ids[0][clear] == ids[1][clear]).all(), kind
        assert len(np.unique(ids[1][clear])) == 2
        assert abs(a[:, :, 1] - b[:, :, 1]).mean() < 0.02


@test
def cryptomatte_files_tell_names():
    floor()
    ball()
    layer = bpy.context.scene.view_layers[0]
    layer.use_pass_cryptomatte_object = True
    texts = []

    def written(scene):
        texts.append(exr.texts(scene.render.filepath, "cryptomatte/"))

    bpy.app.handlers.render_write.append(written)
    render("KEYHOLE", multilayer=True, samples=1)
    bpy.app.handlers.render_write.remove(written)
    text = " ".join(f"{key}={value}" for key, value in texts[0].items())
    for part in (f"name={layer.name}.CryptoObject", "MurmurHash3_32", "uint32_to_float32", '"Plane":', '"Sphere":'):
        assert part in text, (part, text)


@test
def transparent_film():
    """What covers a pixel, as Cycles has it, and no sky."""
    ball(place=(0, 0, 0))
    bpy.context.scene.render.film_transparent = True
    theirs, _ = render("CYCLES")
    ours, messages = render("KEYHOLE")
    expect(messages, [])
    assert ours["A"][0, 0] == ours["R"][0, 0] == 0
    worst = 0.0
    for channel in "RGBA":
        a, b = (x[channel][:48, :64].reshape(6, 8, 8, 8).mean((1, 3)) for x in (theirs, ours))
        worst = max(worst, float((abs(a - b) / np.maximum(a, 0.1 * a.max())).max()))
    assert worst < 0.05, worst
    return worst
