"""The shell of the two rooms: what is not a plain rectangle. rooms.yaml has the measures, too."""

import random

from .furniture import casing
from .mesh import Mesh
from .outline import sheet
from .solids import box

NEAR = (0.0, 0.0, 5.0, 5.4)    # x0, z0, x1, z1 of the room with the camera
FAR = (1.6, -4.12, 5.8, -0.12)  # and of the room with the lights
HEIGHT = 2.6
DOOR = (3.4, 4.3, 2.05)         # x0, x1, height


def shell():
    planks = floor_planks(3)
    return {
        'wall_near': wall_with_door(NEAR[0], NEAR[2]),
        'wall_far': wall_with_door(FAR[0], FAR[2]).turned(180).moved(FAR[0] + FAR[2], 0, FAR[3]),
        'casing': casing(*DOOR, FAR[3], NEAR[1]),
        'threshold': box((DOOR[0] - 0.05, -0.02, FAR[3] - 0.03), (DOOR[1] + 0.05, 0.006, NEAR[1] + 0.03)),
        **{f'planks_{i}': mesh for i, mesh in enumerate(planks)},
    }


def wall_with_door(x0, x1):
    """Faces +z. For a wall that is turned about, the door is mirrored beforehand."""
    a, b, top = DOOR
    if x0 == FAR[0]:
        a, b = x0 + x1 - b, x0 + x1 - a
    return sheet([(x0, 0), (a, 0), (a, top), (b, top), (b, 0), (x1, 0), (x1, HEIGHT), (x0, HEIGHT)])


def floor_planks(tones):
    """The near room's floor in boards of 0.15 m along z, as one mesh for each tone of wood."""
    random_ = random.Random(3)
    meshes = [Mesh() for _ in range(tones)]
    x0, z0, x1, z1 = NEAR
    rows = 30
    for row in range(rows):
        a, b = x0 + (x1 - x0) * row / rows, x0 + (x1 - x0) * (row + 1) / rows
        z, last = z0, None
        while z < z1:
            end = z + 0.7 + 1.2 * random_.random()
            end = z1 if end > z1 - 0.4 else end
            tone = int(random_.random() * tones)
            tone = (tone + 1) % tones if tone == last else tone
            mesh = meshes[tone]
            first = len(mesh.positions)
            mesh.positions += [(a, 0.0, end), (b, 0.0, end), (b, 0.0, z), (a, 0.0, z)]
            mesh.triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
            z, last = end, tone
    return meshes
