"""The whole scene: a folder with scene.yaml (written as JSON, which YAML contains), meshes and pictures."""

import json
import os
from dataclasses import dataclass

from ..messages import Messages
from . import camera, lamps, objects, user_paths, world
from .images import Images
from .materials import Materials


@dataclass
class Exported:
    path: str  # of the scene file
    user_paths: str  # of the file of user paths; empty: none
    messages: Messages


def export(depsgraph, folder):
    """Writes the scene to `folder`, which is made if need be."""
    os.makedirs(folder, exist_ok=True)
    messages, scene = Messages(), depsgraph.scene
    materials = Materials(Images(folder), messages)
    film, view = camera.export(scene, messages)
    paths = user_paths.find(scene) if scene.keyhole.user_paths else []
    shapes = objects.Shapes(folder, materials, messages)
    emitters = []
    for instance in depsgraph.object_instances:
        thing, matrix = instance.object, instance.matrix_world.copy()
        if not instance.show_self or user_paths.is_drawn(scene, thing):
            continue
        if thing.type == "LIGHT":
            emitters += lamps.export(thing, matrix, shapes, messages)
        else:
            shapes.add(thing, matrix, instance.is_instance)
    emitters += world.export(scene.world, materials.images, messages)
    document = {"film": film, "camera": view, "materials": materials.written, "groups": shapes.groups,
                "shapes": shapes.placed(), "emitters": emitters}
    path = os.path.join(folder, "scene.yaml")
    with open(path, "w", encoding="utf-8") as file:
        json.dump({key: value for key, value in document.items() if value}, file, indent=1)
    return Exported(path, user_paths.export(depsgraph, paths, folder, messages), messages)
