"""The carved lantern: six pierced panels under a pierced roof, on a base with feet."""

import math

from .detail import Detail
from .mesh import joined
from .outline import board, circle, leaf, rectangle, star

SIDES = 6
APOTHEM = 0.12   # from the axis to the panels
WALL = 0.004
FLOOR, EAVES, TOP = 0.035, 0.285, 0.37  # heights of the panels' ends, and of the roof's


def metal(d: Detail):
    """Everything but the light: stands on y = 0."""
    width = 2 * APOTHEM * math.tan(math.pi / SIDES)
    panel = board(rectangle(-width / 2 - 0.001, FLOOR, width / 2 + 0.001, EAVES), panel_holes(d, (FLOOR + EAVES) / 2),
                  APOTHEM - WALL, APOTHEM)
    slope = roof_board(d)
    parts = []
    for k in range(SIDES):
        turn = 360 * k / SIDES
        parts += [panel.turned(turn), slope.turned(turn), corner_post(d).turned(turn)]
    return joined(*(p.without_normals() for p in (base(), crown()))).add(joined(*parts, finial(d)))


def panel_holes(d, y):
    """A star between four leaves, and a row of dots above and below."""
    holes = [star(0, y, 0.036, 0.017, 8)]
    for x, h, turn in ((-1, 1, -45), (1, 1, 45), (1, -1, -45), (-1, -1, 45)):
        holes.append(leaf(x * 0.035, y + h * 0.058, 0.05, 0.017, turn, d.count(12, 4)))
    for h in (-0.1, 0.1):
        holes += [circle(x, y + h, 0.0085, d.count(16, 6)) for x in (-0.044, 0.0, 0.044)]
    holes += [circle(0, y + h * 0.068, 0.011, d.count(16, 6)) for h in (-1, 1)]
    return holes


def roof_board(d):
    """One side of the roof: a trapezium with leaves, leaning inwards."""
    reach, inner = APOTHEM + 0.014, 0.03
    run, rise = reach - inner, TOP - EAVES
    length = math.hypot(run, rise)
    half = math.tan(math.pi / SIDES)
    outline = [(-reach * half, 0), (reach * half, 0), (inner * half, length), (-inner * half, length)]
    holes = [leaf(x, y, 0.042, 0.014, turn, d.count(12, 4)) for x, y, turn in ((-0.022, 0.034, 75), (0.022, 0.034, 105))]
    holes += [leaf(0, 0.075, 0.034, 0.013, 90, d.count(12, 4))]
    tilt = -math.degrees(math.atan2(run, rise))
    return board(outline, holes, -WALL, 0).turned(tilt, 'x').moved(0, EAVES, reach)


def corner_post(d):
    x = APOTHEM / math.cos(math.pi / SIDES) - 0.001
    post = d.bar([(0, FLOOR - 0.004, 0), (0, EAVES + 0.012, 0)], 0.0065, 10)
    return post.moved(0, 0, x).turned(180 / SIDES)


def base():
    r = APOTHEM / math.cos(math.pi / SIDES)
    profile = [(0, 0.012), (r + 0.012, 0.012), (r + 0.022, 0.022), (r + 0.012, 0.032), (r + 0.008, FLOOR + 0.004),
               (0, FLOOR + 0.004)]
    return _six_sided(profile)


def crown():
    """The rim under the roof's tip."""
    return _six_sided([(0, TOP - 0.012), (0.042, TOP - 0.01), (0.045, TOP + 0.002), (0.03, TOP + 0.014), (0, TOP + 0.016)])


def _six_sided(profile):
    """A body of revolution with corners where the panels meet."""
    return Detail(False).lathe(profile, SIDES).turned(90 - 180 / SIDES)


def finial(d):
    """A knob on the roof with a ring to carry the lantern by; and three feet."""
    knob = d.lathe([(0, TOP + 0.01), (0.014, TOP + 0.012), (0.009, TOP + 0.022), (0.016, TOP + 0.034), (0.01, TOP + 0.046),
                    (0, TOP + 0.05)], 20)
    n = d.count(32, 8)
    ring = [(0.034 * math.cos(2 * math.pi * i / n), TOP + 0.077 + 0.034 * math.sin(2 * math.pi * i / n), 0) for i in range(n)]
    foot = d.lathe([(0, 0), (0.012, 0.001), (0.017, 0.008), (0.014, 0.0135), (0, 0.014)], 16)
    return joined(knob, d.bar(ring, 0.0045, 10, closed=True),
                  *(foot.moved(0, 0, APOTHEM - 0.01).turned(60 + 120 * k) for k in range(3)))
