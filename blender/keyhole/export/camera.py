"""Camera and film."""

import math

from mathutils import Vector


def resolution(render):
    """Width and height of the whole picture in pixels, as Blender counts them."""
    share = render.resolution_percentage / 100
    return int(render.resolution_x * share), int(render.resolution_y * share)


def crop(render, width, height):
    """[left, top, right, bottom] of the border that is rendered; None: all."""
    if not render.use_border:
        return None
    left, right = int(render.border_min_x * width), int(render.border_max_x * width)
    bottom, top = int(render.border_min_y * height), int(render.border_max_y * height)
    return [left, height - top, right, height - bottom]


def sensor(data, width, height):
    """Size of the sensor [mm] along the side of the picture that it is fitted to, and that side in pixels."""
    fit = data.sensor_fit
    if fit == "AUTO":
        return data.sensor_width, max(width, height)
    return (data.sensor_width, width) if fit == "HORIZONTAL" else (data.sensor_height, height)


def depth_of_field(thing, forward, messages):
    """The thin lens: its radius and the distance of the plane in focus, along the view [m]."""
    data, eye = thing.data, thing.matrix_world.translation
    distance = data.dof.focus_distance
    if data.dof.focus_object:
        distance = (data.dof.focus_object.matrix_world.translation - eye).dot(forward)
    if data.dof.aperture_blades or data.dof.aperture_ratio != 1:
        messages.add(thing.name, "the shape of the aperture is not exported: it is round")
    length = 1 if data.type == "ORTHO" else data.lens / 1000  # what the f-number divides, as Cycles has it [m]
    return {"lens_radius": length / 2 / data.dof.aperture_fstop, "focus_distance": abs(distance)}


def export(scene, messages):
    """The sections `film` and `camera`. Raises ValueError for a scene without camera."""
    thing, render = scene.camera, scene.render
    if thing is None:
        raise ValueError("found no camera, expected one in the scene")
    width, height = resolution(render)
    film = {"resolution": [width, height]}
    if render.use_border:
        film["crop"] = crop(render, width, height)
    if render.pixel_aspect_x != render.pixel_aspect_y:
        messages.add("Output", "pixels that are not square are not exported")
    if render.film_transparent:
        film["transparent"] = True
    data = thing.data
    if data.type not in {"PERSP", "ORTHO"}:
        messages.add(thing.name, f"a camera of type {data.type} is not exported: it is a perspective one")
    axes = thing.matrix_world.to_3x3().normalized()
    forward = -(axes @ Vector((0, 0, 1)))
    eye = thing.matrix_world.translation
    size, side = sensor(data, width, height)
    shorter = min(width, height)
    view = {
        "from": list(eye),
        "to": list(eye + forward),
        "up": list(axes @ Vector((0, 1, 0))),
        "shift": [data.shift_x * side / shorter, data.shift_y * side / shorter],
    }
    if data.type == "ORTHO":
        view["orthographic"] = data.ortho_scale * shorter / side
    else:
        view["fov"] = math.degrees(2 * math.atan(size / 2 / data.lens * shorter / side))
    if data.dof.use_dof:
        view.update(depth_of_field(thing, forward, messages))
    return film, view
