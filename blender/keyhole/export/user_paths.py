"""User paths: curves of the collection "Keyhole Paths", from a lamp on. Rectangles there are openings."""

import json
import os

from mathutils import Vector
from mathutils.geometry import intersect_line_plane

COLLECTION = "Keyhole Paths"
STEP = 1e-4  # metres, off a surface
NEAR = 0.05  # metres from an opening's plane: a point of the curve lies in it
SURFACES = 8  # crossed at most on the way to a point


def find(scene):
    """The collection's objects, if the scene has one."""
    collection = next((c for c in scene.collection.children_recursive if c.name == COLLECTION), None)
    return list(collection.all_objects) if collection else []


def is_drawn(scene, thing):
    """Whether an object is part of the collection, and no part of the scene."""
    return any(other.name == thing.original.name for other in find(scene))


def opening(thing):
    """The parallelogram of a mesh of one face with four corners: corner, u, v; None for others."""
    if thing.type != "MESH" or len(thing.data.polygons) != 1 or len(thing.data.vertices) != 4:
        return None
    a, b, _, d = (thing.matrix_world @ thing.data.vertices[k].co for k in thing.data.polygons[0].vertices)
    return a, b - a, d - a


def holds(hole, place):
    """Whether a point of its plane lies in an opening."""
    corner, u, v = hole
    offset = place - corner
    return 0 <= offset.dot(u) <= u.length_squared and 0 <= offset.dot(v) <= v.length_squared


def passed(holes, start, end):
    """The first opening between two points."""
    for hole in holes:
        corner, u, v = hole
        normal = u.cross(v).normalized()
        place = intersect_line_plane(start, end, corner, normal)
        inside = place is not None and -STEP <= (place - start).dot(end - start) / (end - start).length_squared <= 1
        if inside and holds(hole, place):
            return hole
    return None


def lies_in(holes, place):
    for hole in holes:
        normal = hole[1].cross(hole[2]).normalized()
        if abs(normal.dot(place - hole[0])) < NEAR and holds(hole, place):
            return hole
    return None


def snapped(depsgraph, start, end, drawn):
    """Where the ray from one point towards the next meets a surface; the point itself where it meets none."""
    place, direction = start.copy(), (end - start).normalized()
    for _ in range(SURFACES):
        hit, found, _, _, thing, _ = depsgraph.scene.ray_cast(depsgraph, place + direction * STEP, direction)
        if not hit:
            break
        if thing.name not in drawn:
            return found
        place = found
    return end


def points_of(thing, spline):
    points = spline.bezier_points if spline.type == "BEZIER" else spline.points
    return [thing.matrix_world @ Vector(point.co[:3]) for point in points]


def path_points(depsgraph, points, holes, drawn, bounces):
    """Entries of `points` in a file of user paths."""
    entries, start = [list(points[0])], points[0]
    if bounces is not None:
        entries.append({"bounces": bounces})
    through = None
    for end in points[1:]:
        through = lies_in(holes, end) or through
        if lies_in(holes, end):
            continue  # the curve has a point in the opening; the next one is behind it
        through = through or passed(holes, start, end)
        if through:
            corner, u, v = through
            entries.append({"through": {"corner": list(corner), "u": list(u), "v": list(v)}})
            start = corner + (u + v) / 2
        entries.append(list(snapped(depsgraph, start, end, drawn)))
        start, through = end, None
    return entries


def whole(bounces):
    """A custom property: one number, or several."""
    return [int(x) for x in bounces] if hasattr(bounces, "__len__") else int(bounces)


def export(depsgraph, things, folder, messages):
    """Writes a file of the drawn paths. Returns its path; empty: there are none."""
    holes = [hole for hole in map(opening, things) if hole]
    drawn, paths = {thing.name for thing in things}, []
    for thing in things:
        if thing.type != "CURVE":
            if opening(thing) is None:
                messages.add(thing.name, f'no part of a path: expected curves and rectangles in "{COLLECTION}"')
            continue
        bounces = whole(thing["bounces"]) if "bounces" in thing else None
        for spline in thing.data.splines:
            points = points_of(thing, spline)
            if len(points) < 2:
                messages.add(thing.name, "a path of one point is not exported")
                continue
            path = {"name": thing.name, "points": path_points(depsgraph, points, holes, drawn, bounces)}
            path.update({key: float(thing[key]) for key in ("weight", "beta", "patch", "tolerance") if key in thing})
            paths.append(path)
    if not paths:
        return ""
    file = os.path.join(folder, "paths.yaml")
    with open(file, "w", encoding="utf-8") as out:
        json.dump({"paths": paths}, out, indent=1)
    return file
