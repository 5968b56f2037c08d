"""A kitchen: cupboard fronts with their handles, a sink and its tap, pots, and the wall with the window."""

import math

from .mesh import joined
from .outline import board, rectangle
from .solids import box, rounded_box, tube
from .things import curve, vessel


def front(d, width, lower, upper):
    """A cupboard's door or drawer front, 20 mm thick before z = 0, between two heights [m]."""
    return rounded_box((0.002, lower, 0), (width - 0.002, upper, 0.02), 0.003, 2 if d.fine else 1)


def handle(d, length):
    """A bent bar, 35 mm proud of z = 0, along x from the origin."""
    depth, bend = 0.035, 0.012
    corner = [(math.sin(t), 1 - math.cos(t)) for t in (0, math.pi / 6, math.pi / 3, math.pi / 2)]
    left = [(bend * b, 0, depth - bend + bend * a) for a, b in corner]
    points = [(0, 0, 0)] + left + [(length - x, y, z) for x, y, z in left[::-1]] + [(length, 0, 0)]
    return tube(points, 0.005, 12 if d.fine else 6)


def sink(width, depth, height):
    """A tub of sheet metal, its rim at y = 0 and its opening from (0, 0) to (width, depth) in x and z."""
    wall = 0.002
    return joined(box((-wall, -height, -wall), (width + wall, wall - height, depth + wall)),
                  box((-wall, -height, -wall), (0, 0.001, depth + wall)),
                  box((width, -height, -wall), (width + wall, 0.001, depth + wall)),
                  box((0, -height, -wall), (width, 0.001, 0)),
                  box((0, -height, depth), (width, 0.001, depth + wall)))


def tap(d):
    """A swan neck, 0.32 m high, that pours 0.2 m before its foot at the origin, along z."""
    n = 16 if d.fine else 6
    neck = [(0, 0.22 + 0.1 * math.sin(math.pi * i / n), 0.1 - 0.1 * math.cos(math.pi * i / n)) for i in range(n + 1)]
    segments = 24 if d.fine else 8
    return joined(d.lathe([(0, 0), (0.026, 0), (0.026, 0.004), (0.02, 0.012), (0.02, 0.07), (0, 0.07)], 32),
                  tube([(0, 0.06, 0)] + neck + [(0, 0.19, 0.2)], 0.011, segments),
                  tube([(0.018, 0.045, 0), (0.05, 0.05, 0), (0.09, 0.075, 0)], [0.008, 0.006, 0.005], segments))


def pan(d):
    """A saucepan, 0.18 m wide, with its handle along x."""
    body = vessel(d, [(0.08, 0), (0.088, 0.006), (0.09, 0.02), (0.09, 0.105), (0.093, 0.11)], 0.002, 64)
    grip = tube([(0.088, 0.085, 0), (0.14, 0.095, 0), (0.27, 0.1, 0)], [0.006, 0.008, 0.009], 16 if d.fine else 6)
    return joined(body, grip)


def kettle(d):
    """Bellied, with a spout along x and a bow over it."""
    side = curve(d, [(0.09, 0), (0.105, 0.03), (0.1, 0.08), (0.065, 0.13), (0.03, 0.145)], 4)
    body = d.lathe([(0, 0)] + side + [(0.012, 0.15), (0.012, 0.165), (0, 0.168)], 64)
    n = 12 if d.fine else 5
    bow = [(0.085 * math.cos(math.pi * i / n), 0.115 + 0.11 * math.sin(math.pi * i / n), 0) for i in range(n + 1)]
    segments = 16 if d.fine else 6
    spout = tube([(0.08, 0.06, 0), (0.13, 0.09, 0), (0.16, 0.135, 0)], [0.018, 0.013, 0.01], segments)
    return joined(body, tube(bow, 0.006, segments), spout)


def window_wall(width, height, left, sill, right, lintel):
    """A wall in the plane z = 0, 0.22 m thick, with an opening between (left, sill) and (right, lintel)."""
    hole = rectangle(left, sill, right, lintel)[::-1]
    return board(rectangle(-0.2, -0.2, width + 0.2, height + 0.2), [hole], -0.22, 0)


def window_frame(left, sill, right, lintel):
    """Four bars in an opening and one in its middle."""
    rim, deep = 0.05, (-0.14, -0.09)
    middle = (left + right) / 2
    bars = [(left, sill, right, sill + rim), (left, lintel - rim, right, lintel), (left, sill + rim, left + rim, lintel - rim),
            (right - rim, sill + rim, right, lintel - rim), (middle - rim / 2, sill + rim, middle + rim / 2, lintel - rim)]
    return joined(*[box((x0, y0, deep[0]), (x1, y1, deep[1])) for x0, y0, x1, y1 in bars])
