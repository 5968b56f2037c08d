"""Tables, seats and doors. All stand on y = 0, centred, and face +z."""

import math

from .mesh import joined
from .outline import board, rectangle
from .solids import box


def chair(d):
    """A kitchen chair with a gently bent back: seat at 0.46 m, 0.88 m high."""
    parts = [d.block((-0.21, 0.44, -0.2), (0.21, 0.47, 0.21), 0.013, 2)]
    for side in (-1, 1):
        parts.append(d.bar([(side * 0.2, 0.0, 0.2), (side * 0.17, 0.445, 0.17)], [0.012, 0.018], 10))
        post = [(side * (0.2 - 0.02 * t), 0.88 * t, -0.22 + 0.12 * math.sin(math.pi * t) - 0.06 * t) for t in steps(10)]
        parts.append(d.bar(post, 0.016, 10))
        parts.append(d.bar([(side * 0.192, 0.2, 0.186), (side * 0.192, 0.2, -0.17)], 0.009, 8))
    for height in (0.62, 0.71, 0.8, 0.865):
        t = height / 0.88
        z = -0.22 + 0.12 * math.sin(math.pi * t) - 0.06 * t
        rail = [(0.19 * u, height, z - 0.035 * (1 - u * u)) for u in (2 * s - 1 for s in steps(8))]
        parts.append(d.bar(rail, 0.013 if height > 0.85 else 0.009, 8))
    return joined(*parts)


def table(d, width, depth, height, top=0.03, leg=0.03):
    """Turned legs under an apron and a rounded top."""
    parts = [d.block((-width / 2, height - top, -depth / 2), (width / 2, height, depth / 2), 0.012, 3),
             box((-width / 2 + 0.07, height - top - 0.07, -depth / 2 + 0.07),
                 (width / 2 - 0.07, height - top + 0.005, depth / 2 - 0.07))]
    for x in (-1, 1):
        for z in (-1, 1):
            profile = [(0, 0), (0.6 * leg, 0)]
            profile += [(leg * (0.6 + 0.4 * t + 0.12 * math.sin(6 * math.pi * t) * (1 - t)), t * (height - top - 0.001))
                        for t in steps(d.count(10, 2))[1:]]
            parts.append(d.lathe(profile + [(0, height - top - 0.001)], 16)
                         .moved(x * (width / 2 - 0.08), 0, z * (depth / 2 - 0.08)))
    return joined(*parts)


def round_table(d, radius, height):
    """On one turned column with three feet."""
    top = [(0, height - 0.03), (radius - 0.02, height - 0.03), (radius - 0.005, height - 0.022), (radius, height - 0.012),
           (radius - 0.004, height - 0.003), (radius - 0.015, height), (0, height)]
    column = [(0, 0.06), (0.05, 0.06), (0.055, 0.1), (0.035, 0.16), (0.03, 0.3), (0.045, 0.42), (0.03, 0.5), (0.035, 0.6),
              (0.07, height - 0.05), (0.09, height - 0.029), (0, height - 0.029)]
    parts = [d.lathe(top, 64), d.lathe(column, 24)]
    for k in range(3):
        foot = [(0.36 * t, 0.16 - 0.135 * t ** 1.7, 0) for t in steps(10)]
        parts.append(d.bar(foot, [0.035 - 0.015 * t for t in steps(10)], 12).turned(30 + 120 * k))
    return joined(*parts)


def sofa_frame(d, width):
    """Arms, back and base; legs are in sofa_legs(). 0.9 m deep."""
    half = width / 2
    return joined(d.block((-half + 0.1, 0.12, -0.43), (half - 0.1, 0.29, 0.42), 0.03, 3),
                  d.block((-half, 0.1, -0.45), (-half + 0.2, 0.6, 0.44), 0.07, 3),
                  d.block((half - 0.2, 0.1, -0.45), (half, 0.6, 0.44), 0.07, 3),
                  d.block((-half + 0.15, 0.1, -0.46), (half - 0.15, 0.8, -0.24), 0.08, 3))


def sofa_cushions(d, width, seats):
    """Seat and back cushions, plumped."""
    parts, each = [], (width - 0.42) / seats
    for i in range(seats):
        x0 = -width / 2 + 0.21 + i * each
        parts.append(d.block((x0 + 0.004, 0.28, -0.24), (x0 + each - 0.004, 0.44, 0.46), 0.05, 2, 3, 0.035))
        back = d.block((-each / 2 + 0.01, -0.085, -0.25), (each / 2 - 0.01, 0.085, 0.25), 0.06, 2, 3, 0.05)
        parts.append(back.turned(90 - 12, 'x').moved(x0 + each / 2, 0.69, -0.17))
    return joined(*parts)


def sofa_legs(d, width):
    return joined(*(d.bar([(x * (width / 2 - 0.1), 0, z), (x * (width / 2 - 0.12), 0.13, 0.9 * z)], [0.016, 0.026], 10)
                    for x in (-1, 1) for z in (-0.36, 0.36)))


def cushion(d):
    """A square sofa cushion, lying, 0.42 m wide."""
    return d.block((-0.21, -0.06, -0.21), (0.21, 0.06, 0.21), 0.05, 2, 3, 0.055)


def sideboard(d, width):
    """0.42 m deep, 0.78 m high, with doors that stand a little proud, and knobs."""
    half = width / 2
    parts = [d.block((-half, 0.12, -0.21), (half, 0.76, 0.19), 0.006, 1),
             d.block((-half - 0.02, 0.755, -0.21), (half + 0.02, 0.785, 0.22), 0.01, 2)]
    doors = max(2, round(width / 0.45))
    each = width / doors
    for i in range(doors):
        x0 = -half + i * each
        frame = board(rectangle(x0 + 0.008, 0.135, x0 + each - 0.008, 0.745),
                      [rectangle(x0 + 0.07, 0.2, x0 + each - 0.07, 0.68)], 0.188, 0.205)
        knob = d.lathe([(0, 0), (0.006, 0), (0.006, 0.01), (0.014, 0.018), (0.012, 0.028), (0, 0.03)], 12).turned(90, 'x')
        parts += [frame, knob.moved(x0 + (0.04 if i % 2 else each - 0.04), 0.45, 0.204)]
    parts += [d.bar([(x * (half - 0.05), 0, z), (x * (half - 0.05), 0.125, z)], [0.014, 0.022], 10)
              for x in (-1, 1) for z in (-0.16, 0.14)]
    return joined(*parts)


def door_leaf(width, height):
    """Hinged at x = 0, reaching to +x, 0.04 m thick, with four sunk panels on either side."""
    middle = width / 2
    holes = [rectangle(x0, y0, x1, y1) for x0, x1 in ((0.11, middle - 0.045), (middle + 0.045, width - 0.11))
             for y0, y1 in ((0.2, 0.85), (1.0, height - 0.13))]
    return joined(board(rectangle(0, 0.004, width, height), holes, -0.02, 0.02),
                  box((0.09, 0.18, -0.008), (width - 0.09, height - 0.11, 0.008)))


def door_handle(d, width):
    """A rosette and a lever on both sides of door_leaf()."""
    parts = []
    for side in (0, 180):
        plate = d.lathe([(0, 0), (0.026, 0), (0.024, 0.008), (0, 0.009)], 20).turned(90, 'x').moved(0, 0, 0.0195)
        lever = d.bar([(0, 0, 0.026), (0, 0, 0.055), ((0.02, -0.02)[side == 180], 0, 0.066),
                       ((0.11, -0.11)[side == 180] * -1, 0, 0.066)], 0.0085, 10)
        parts += [plate.turned(side), lever.turned(side)]
    return joined(*parts).moved(width - 0.06, 1.0, 0)


def casing(x0, x1, height, z0, z1):
    """Lining and architraves of a doorway through a wall. They are three pieces, since a face that ran through the wall would
    have its lit end in one room and its dark end in the other, closer together than photons of one estimate."""
    return joined(_arch(x0, x1, height, -0.02, 0.01, z0 + 0.001, z1 - 0.001),
                  *(_arch(x0, x1, height, -0.014, 0.075, *z) for z in ((z0 - 0.018, z0 + 0.002), (z1 - 0.002, z1 + 0.018))))


def _arch(x0, x1, height, inner, outer, z0, z1):
    """An upturned U around an opening, from `inner` to `outer` beyond its edge."""
    outline = [(x0 - outer, -0.005), (x0 - inner, -0.005), (x0 - inner, height + inner), (x1 + inner, height + inner),
               (x1 + inner, -0.005), (x1 + outer, -0.005), (x1 + outer, height + outer), (x0 - outer, height + outer)]
    return board(outline, [], z0, z1)


def steps(n):
    return [i / n for i in range(n + 1)]
