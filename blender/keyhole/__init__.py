"""Keyhole as a render engine of Blender: exports the scene, runs `keyhole render`, shows its picture and passes."""

bl_info = {
    "name": "Keyhole",
    "description": "Photon mapping with paths that you draw",
    "blender": (3, 4, 0),
    "version": (1, 0, 0),
    "category": "Render",
    "support": "COMMUNITY",
}

from . import engine, labels, panels, preferences, settings, tools  # noqa: E402  (Blender reads bl_info without running the rest)

PARTS = preferences, settings, engine, tools, labels, panels


def register():
    for part in PARTS:
        part.register()


def unregister():
    for part in reversed(PARTS):
        part.unregister()
