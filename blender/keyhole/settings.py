"""Settings of a render, kept with Blender's scene as `scene.keyhole`, and the options of `keyhole render` they become."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

METHODS = [(word, label, text) for word, label, text in (
    ("auto", "Automatic", "The method that leaves the least error in the time, by short trials"),
    ("mps", "Metropolis photons", "Photons that Markov chains sample where they are seen"),
    ("ipm", "Importance-driven photons", "Photons emitted towards what is seen"),
    ("pm", "Photon map", "Standard photon mapping"),
    ("mlt", "Metropolis light transport", "Chains of paths, without photon maps"),
    ("bdpt", "Bidirectional", "Bidirectional path tracing"),
    ("path", "Path tracing", "Paths from the eye"),
)]
EFFORTS = [
    ("TIME", "Time", "The best picture for a time"),
    ("QUALITY", "Quality", "Effort in one word"),
    ("ERROR", "Error", "Until the error is small enough"),
]
QUALITIES = [(word, word.capitalize(), text) for word, text in (
    ("draft", "About 8 samples a pixel"), ("good", "About 24 samples a pixel"), ("final", "About 59 samples a pixel"))]


class KeyholeSettings(bpy.types.PropertyGroup):
    __annotations__ = {  # what Blender makes properties of
        "method": EnumProperty(name="Method", items=METHODS),
        "effort": EnumProperty(name="Until", items=EFFORTS),
        "time": FloatProperty(name="Time", subtype="TIME", unit="TIME", default=30, min=0.1, soft_max=3600,
            description="Seconds from when the scene is read"),
        "quality": EnumProperty(name="Quality", items=QUALITIES, default="good"),
        "target_error": FloatProperty(name="Error", default=0.02, min=1e-4, max=1, precision=4,
            description="Relative standard error of the picture to reach"),
        "photon_memory": IntProperty(name="Photon memory", default=0, min=0, subtype="UNSIGNED",
            description="For photons, in MiB; 0: as Keyhole chooses"),
        "seed": IntProperty(name="Seed", default=1, min=0),
        "threads": IntProperty(name="Threads", default=0, min=0, max=4096, description="0: one for each core"),
        "denoise": BoolProperty(name="Denoise", default=True,
            description="Filter what samples of pixels leave of grain in the pass Combined; Unfiltered stays as it was"),
        "noise_passes": BoolProperty(name="Noise", default=False,
            description="What two halves of the samples differ in, as passes"),
        "user_paths": BoolProperty(name="User paths", default=True,
            description="Use the curves of the collection \"Keyhole Paths\""),
        "options": StringProperty(name="More options",
            description="Further options of `keyhole render`, such as -D gather_rays=256"),
    }


def arguments(settings):
    """Options for `keyhole render`."""
    args = ["--method", settings.method, "--seed", str(settings.seed), "-t", str(settings.threads)]
    if settings.effort == "TIME":
        args += ["--timeout", repr(round(settings.time, 3))]
    elif settings.effort == "QUALITY":
        args += ["--quality", settings.quality]
    else:
        args += ["--target-error", repr(round(settings.target_error, 6))]
    if settings.photon_memory:
        args += ["--photon-memory", f"{settings.photon_memory}MiB"]
    args += ["--denoise", "exr" if settings.denoise else "off"]
    if settings.noise_passes:
        args += ["-D", "noise_layers=true"]
    return args + settings.options.split()


def register():
    bpy.utils.register_class(KeyholeSettings)
    bpy.types.Scene.keyhole = PointerProperty(type=KeyholeSettings)


def unregister():
    del bpy.types.Scene.keyhole
    bpy.utils.unregister_class(KeyholeSettings)
