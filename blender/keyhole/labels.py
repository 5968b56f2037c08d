"""What the last check said of each user path, beside its curve in the viewport."""

from dataclasses import dataclass

import blf
import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

GOOD, BAD = (0.3, 1, 0.4, 1), (1, 0.35, 0.25, 1)
SIZE = 13  # points


@dataclass
class Check:
    good: bool
    text: str


CHECKED = {}  # by name of the curve
handlers = []


def end_of(thing):
    """The last point of a curve, in the world."""
    spline = thing.data.splines[-1]
    points = spline.bezier_points if spline.type == "BEZIER" else spline.points
    return thing.matrix_world @ Vector(points[-1].co[:3])


def draw():
    context = bpy.context
    blf.size(0, SIZE, 72)
    for name, check in CHECKED.items():
        thing = context.scene.objects.get(name)
        if thing is None or thing.type != "CURVE" or not thing.data.splines or not thing.visible_get():
            continue
        place = location_3d_to_region_2d(context.region, context.region_data, end_of(thing))
        if place is not None:
            blf.position(0, place.x + SIZE, place.y, 0)
            blf.color(0, *(GOOD if check.good else BAD))
            blf.draw(0, f"{name}: {check.text}")


def redraw():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            area.tag_redraw()


def register():
    if not bpy.app.background:
        handlers.append(bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_PIXEL"))


def unregister():
    CHECKED.clear()
    while handlers:
        bpy.types.SpaceView3D.draw_handler_remove(handlers.pop(), "WINDOW")
