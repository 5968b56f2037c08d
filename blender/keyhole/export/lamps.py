"""Lamps. Those with a size are shapes with the opacity 0: like Cycles' they shine, but are not seen and hide nothing."""

import math

import numpy as np
from mathutils import Vector

CORNERS = 64  # of a disc
SHARPEST_EDGE = 1e-3  # degrees
NARROWEST_SPREAD = 1  # degrees


def colour(thing, messages):
    """Power [W], for the sun irradiance [W/m^2], as a colour; of a lamp with nodes times its Emission node."""
    light = thing.data
    rgb = [light.energy * x for x in light.color]
    if light.use_nodes:
        node = next((n for n in light.node_tree.nodes if n.type == "EMISSION"), None)
        used = [x for n in light.node_tree.nodes for x in n.inputs if x.is_linked and n.type != "OUTPUT_LIGHT"]
        if node is None or used:
            messages.add(thing.name, "its nodes are not exported, but for one Emission node")
        if node:
            strength = node.inputs["Strength"].default_value
            rgb = [a * strength * b for a, b in zip(rgb, node.inputs["Color"].default_value)]
    if min(rgb) < 0:
        messages.add(thing.name, "a lamp that takes light away is not exported")
        return [0, 0, 0]
    return rgb


def scaled(rgb, factor):
    return [x * factor for x in rgb]


def glowing(shape, radiance, **profile):
    return dict(shape, alpha=0, emission={"radiance": radiance, **profile})


def brighter_by_spread(spread):
    """Cycles keeps the power of a lamp whose slats leave light within an angle: radiance along the normal grows."""
    half = spread / 2
    return 1 / (1 - half / math.tan(half))


def area(thing, matrix, rgb, shapes, messages):
    """One-sided, towards its local -z. Radiance as Cycles has it: power over 4 times the area."""
    light = thing.data
    width = light.size
    height = light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else light.size
    u, v = matrix.to_3x3() @ Vector((width, 0, 0)), matrix.to_3x3() @ Vector((0, height, 0))
    profile = {}
    if light.spread < math.pi - 1e-4:
        profile = {"spread": max(math.degrees(light.spread), NARROWEST_SPREAD)}
        rgb = scaled(rgb, brighter_by_spread(math.radians(profile["spread"])))
    centre, surface = matrix.translation, u.cross(v).length
    if surface == 0:
        messages.add(thing.name, "an area lamp without area is not exported")
        return []
    if light.shape in {"SQUARE", "RECTANGLE"}:
        shape = {"type": "rectangle", "corner": list(centre - (u + v) / 2), "u": list(v), "v": list(u)}
        return [glowing(shape, scaled(rgb, 1 / (4 * surface)), **profile)]
    return [glowing(disc(centre, u / 2, v / 2, shapes), scaled(rgb, 1 / (math.pi * surface)), **profile)]


def disc(centre, u, v, shapes):
    """An ellipse of half axes u and v, shining along v x u, as a polygon of its area."""
    step = 2 * math.pi / CORNERS
    grow = math.sqrt(step / math.sin(step))
    rim = [centre + grow * (math.cos(k * step) * u + math.sin(k * step) * v) for k in range(CORNERS + 1)]
    return shapes.mesh(np.array([p for k in range(CORNERS) for p in (centre, rim[k + 1], rim[k])], np.float32))


def ball(matrix, radius, rgb):
    shape = {"type": "sphere", "center": list(matrix.translation), "radius": radius}
    return glowing(shape, scaled(rgb, 1 / (4 * math.pi ** 2 * radius ** 2)))


def spot(thing, matrix, rgb, shapes):
    """Fades by the same smooth step of the cosine as Cycles', which dims by the cosine besides. So does a disc across
    its axis, that of a spot with a radius; one without is dimmed by the mean. Returns emitters without a shape."""
    light = thing.data
    edge = math.cos(light.spot_size / 2)
    inner = math.acos(edge + (1 - edge) * light.spot_blend)
    half, mean_cosine = light.spot_size / 2, (1 + edge) / 2
    cone = {"angle": math.degrees(half), "falloff": max(math.degrees(half - inner), SHARPEST_EDGE)}
    radius = light.shadow_soft_size
    if radius > 0:
        axes = matrix.to_3x3().normalized()
        shape = disc(matrix.translation, axes @ Vector((radius, 0, 0)), axes @ Vector((0, radius, 0)), shapes)
        shapes.top.append(glowing(shape, scaled(rgb, 1 / (4 * math.pi ** 2 * radius ** 2)), **cone))
        return []
    return [{"type": "spot", "position": list(matrix.translation), "direction": forward(matrix), **cone,
             "intensity": scaled(rgb, mean_cosine / (4 * math.pi))}]


def forward(matrix):
    return list(-(matrix.to_3x3() @ Vector((0, 0, 1))).normalized())


def export(thing, matrix, shapes, messages):
    """Adds a lamp to the shapes. Returns those that are emitters without a shape, as a list."""
    rgb, light = colour(thing, messages), thing.data
    if max(rgb) == 0:
        return []
    if light.type == "AREA":
        shapes.top += area(thing, matrix, rgb, shapes, messages)
    elif light.type == "POINT" and light.shadow_soft_size > 0:
        shapes.top.append(ball(matrix, light.shadow_soft_size, rgb))
    elif light.type == "POINT":
        return [{"type": "point", "position": list(matrix.translation),
                 "intensity": scaled(rgb, 1 / (4 * math.pi))}]
    elif light.type == "SPOT":
        return spot(thing, matrix, rgb, shapes)
    elif light.type == "SUN":
        return [{"type": "distant", "direction": forward(matrix), "irradiance": rgb,
                 "angle": min(math.degrees(light.angle), 90)}]
    return []
