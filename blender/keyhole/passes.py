"""Passes of a render: what they are called in Blender, and the channels of Keyhole's EXR files that they come from."""

import zlib

import numpy as np

from . import exr

# name in Blender, names of its channels there, kind there, channels of the EXR file
PASSES = [
    ("Depth", "Z", "VALUE", ["depth.Z"]),
    ("Normal", "XYZ", "VECTOR", ["normal.X", "normal.Y", "normal.Z"]),
    ("Albedo", "RGB", "COLOR", ["albedo.R", "albedo.G", "albedo.B"]),
    ("Direct", "RGB", "COLOR", ["direct.R", "direct.G", "direct.B"]),
    ("Indirect", "RGB", "COLOR", ["indirect.R", "indirect.G", "indirect.B"]),
    ("Caustics", "RGB", "COLOR", ["caustic.R", "caustic.G", "caustic.B"]),
]
UNFILTERED = [("Unfiltered", "RGB", "COLOR", ["unfiltered.R", "unfiltered.G", "unfiltered.B"])]
NOISE = [(f"Noise {name}", letters, kind, [f"noise.{channel}" for channel in channels])
         for name, letters, kind, channels in PASSES]
MATTES = {"CryptoObject": "use_pass_cryptomatte_object", "CryptoMaterial": "use_pass_cryptomatte_material"}
MATTE_LAYERS = 3  # of two names each


def mattes(layer):
    """The Cryptomatte passes that a view layer asks for."""
    for kind, switch in MATTES.items():
        if getattr(layer, switch):
            for i in range(MATTE_LAYERS):
                name = f"{kind}{i:02}"
                yield name, "rgba", "COLOR", [f"{name}.{letter}" for letter in "RGBA"]


def of_layer(scene, layer):
    chosen = scene.keyhole
    return PASSES + UNFILTERED * chosen.denoise + NOISE * chosen.noise_passes + list(mattes(layer))


def register_all(engine, scene, layer):
    """Tells Blender's compositor what a render has."""
    engine.register_pass(scene, layer, "Combined", 4, "RGBA", "COLOR")
    for name, letters, kind, _ in of_layer(scene, layer):
        engine.register_pass(scene, layer, name, len(letters), letters, kind)


def add_all(engine, scene, layer):
    """Makes room for them; Blender makes it for its own passes where they are asked for."""
    for name, letters, _, _ in of_layer(scene, layer):
        engine.add_pass(name, len(letters), letters, layer=layer.name)


def combined(channels):
    """Those of the picture; opaque where the file has no alpha."""
    alpha = channels["A"] if "A" in channels else np.ones_like(channels["R"])
    return {"R": channels["R"], "G": channels["G"], "B": channels["B"], "A": alpha}


def manifests(path, layer):
    """What a file says of its Cryptomatte layers, as Blender keeps it: with the view layer before their names."""
    found, written = {}, exr.texts(path, "cryptomatte/")
    for name, text in written.items():
        group, kind = name.rsplit("/", 1)
        title = f"{layer.name}.{written[group + '/name']}"
        key = f"{zlib.crc32(title.encode()):08x}"[:7]  # readers ask for one of its own alone
        found[f"cryptomatte/{key}/{kind}"] = title if kind == "name" else text
    return found


def put_picture(engine, layer, channels, file):
    """Hands the picture alone of a view layer to Blender, by way of a file that is free to be written."""
    exr.write(file, combined(channels))
    height, width = channels["R"].shape
    result = engine.begin_result(0, 0, width, height, layer=layer.name)
    result.layers[0].load_from_file(file)
    engine.end_result(result)


def put(engine, scene, layer, channels, attributes, file):
    """Hands all passes of a view layer to Blender, in the same way: `channels` maps those of Keyhole's EXR files to
    arrays (height, width). `attributes` are for the files that Blender writes."""
    named = {f"{layer.name}.Combined.{letter}": values for letter, values in combined(channels).items()}
    if "unfiltered.R" not in channels:  # there was no time to filter it
        channels = channels | {f"unfiltered.{letter}": channels[letter] for letter in "RGB"}
    for name, letters, _, names in of_layer(scene, layer):
        if names[0] in channels:
            named.update({f"{layer.name}.{name}.{letter}": channels[c] for letter, c in zip(letters, names)})
    exr.write(file, named)
    height, width = channels["R"].shape
    result = engine.begin_result(0, 0, width, height, layer=layer.name)
    result.load_from_file(file)
    engine.end_result(result)
    for name, text in attributes.items():
        engine.get_result().stamp_data_add_field(name, text)
