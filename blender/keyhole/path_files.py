"""User paths that `keyhole paths suggest` wrote, as curves and rectangles of the collection "Keyhole Paths"."""

import json
import re

import bpy
from mathutils import Vector

from .export.user_paths import COLLECTION

KEY = re.compile(r"(\w+):")
FIRST, ENTRY = "  - ", "      - "


def value(text):
    """A number, list or map of numbers as such files have them: JSON, but for the quotes."""
    if text.startswith("'"):
        return text[1:-1].replace("''", "'")
    return json.loads(KEY.sub(r'"\1":', text))


def parse(text):
    """[{"name": ..., "points": [...], ...}, ...]. Raises ValueError for what the program doesn't write."""
    paths = []
    for line in text.splitlines():
        if line.startswith(ENTRY):
            entry = line[len(ENTRY):]
            whole = entry.startswith("[")
            paths[-1]["points"].append(value(entry if whole else "{" + entry + "}"))
        elif line.startswith("   ") or line.startswith(FIRST):
            if line.startswith(FIRST):
                paths.append({"points": []})
            key, _, rest = line.lstrip(" -").partition(":")
            if rest:
                paths[-1][key] = value(rest.strip())
    return paths


def collection():
    """The collection of paths, made if there is none."""
    found = bpy.data.collections.get(COLLECTION)
    if found is None:
        found = bpy.data.collections.new(COLLECTION)
    if found.name not in bpy.context.scene.collection.children:
        bpy.context.scene.collection.children.link(found)
    return found


def rectangle(name, hole, owner):
    corner, u, v = (Vector(hole[key]) for key in ("corner", "u", "v"))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([corner, corner + u, corner + u + v, corner + v], [], [(0, 1, 2, 3)])
    thing = bpy.data.objects.new(name, mesh)
    thing.display_type = "WIRE"
    owner.objects.link(thing)
    return corner + (u + v) / 2


def curve(path, owner):
    """One path; the rectangles of its openings besides. Returns the curve."""
    points, bounces = [], None
    for entry in path["points"]:
        if isinstance(entry, list):
            points.append(entry)
        elif "bounces" in entry:
            bounces = entry["bounces"]
        else:
            points.append(rectangle(path["name"] + " opening", entry["through"], owner))
    data = bpy.data.curves.new(path["name"], "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(len(points) - 1)
    for point, place in zip(spline.points, points):
        point.co = (*place, 1)
    thing = bpy.data.objects.new(path["name"], data)
    owner.objects.link(thing)
    thing["weight"] = float(path.get("weight", 1))
    beta = path.get("beta", 5)
    thing["beta"] = float(max(beta) if isinstance(beta, list) else beta)  # a curve has one for all
    if bounces is not None:
        thing["bounces"] = bounces
    return thing


def draw(text):
    """Makes curves of the text of a file of user paths. Returns them."""
    owner = collection()
    return [curve(path, owner) for path in parse(text)]
