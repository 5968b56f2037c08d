"""Passes of a render: what they are called in Blender, and the channels of Keyhole's EXR files that they come from."""

import numpy as np

# name in Blender, names of its channels there, kind there, channels of the EXR file
PASSES = [
    ("Depth", "Z", "VALUE", ["depth.Z"]),
    ("Normal", "XYZ", "VECTOR", ["normal.X", "normal.Y", "normal.Z"]),
    ("Albedo", "RGB", "COLOR", ["albedo.R", "albedo.G", "albedo.B"]),
    ("Direct", "RGB", "COLOR", ["direct.R", "direct.G", "direct.B"]),
    ("Indirect", "RGB", "COLOR", ["indirect.R", "indirect.G", "indirect.B"]),
    ("Caustics", "RGB", "COLOR", ["caustic.R", "caustic.G", "caustic.B"]),
]


def register_all(engine, scene, layer):
    """Tells Blender's compositor what a render has."""
    engine.register_pass(scene, layer, "Combined", 4, "RGBA", "COLOR")
    for name, letters, kind, _ in PASSES:
        engine.register_pass(scene, layer, name, len(letters), letters, kind)


def add_all(engine):
    """Makes room for them; Blender makes it for its own passes where they are asked for."""
    for name, letters, _, _ in PASSES:
        engine.add_pass(name, len(letters), letters)


def rows(channels, names):
    """Pixels from the bottom row up, as Blender has them: (pixels, channels)."""
    pixels = np.stack([channels[name] for name in names], 2)[::-1]
    return np.ascontiguousarray(pixels, np.float32).reshape(-1, len(names))


def combined(channels):
    """RGBA; opaque where the file has no alpha."""
    if "A" not in channels:
        channels = dict(channels, A=np.ones_like(channels["R"]))
    return rows(channels, ["R", "G", "B", "A"])


def put(engine, layer, channels):
    """Hands the picture of a view layer to Blender: a map from channels of Keyhole's EXR files to arrays (height, width)."""
    height, width = channels["R"].shape
    result = engine.begin_result(0, 0, width, height, layer=layer)
    for render_pass in result.layers[0].passes:
        if render_pass.name == "Combined":
            render_pass.rect = combined(channels)
        for name, _, _, names in PASSES:
            if render_pass.name == name and names[0] in channels:
                render_pass.rect = rows(channels, names)
    engine.end_result(result)
