"""What stands on the furniture: lamps, vessels, books, plants."""

import math
import random

from .furniture import steps
from .mesh import Mesh, joined, unit
from .outline import board, rectangle
from .solids import box


def vessel(d, outline, wall, segments=48):
    """A closed, thin-walled body of revolution from the outside (radius, height) points of its wall, foot first."""
    inside = [(r - wall, y) for r, y in outline]
    floor = outline[0][1] + 1.5 * wall
    inside = [(inside[0][0], floor)] + [p for p in inside[1:] if p[1] > floor + 0.1 * wall]
    lip = (outline[-1][0] - wall / 2, outline[-1][1] + wall / 2)
    return d.lathe([(0, outline[0][1])] + outline + [lip] + inside[::-1] + [(0, floor)], segments)


def curve(d, points, pieces):
    """A Catmull-Rom curve through (radius, height) points."""
    if not d.fine:
        return [(r, y) for r, y in points]
    ends = [points[0]] + points + [points[-1]]
    line = []
    for a, b, c, e in zip(ends, ends[1:], ends[2:], ends[3:]):
        for i in range(pieces):
            t = i / pieces
            line.append(tuple(0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - s) * t * t + (3 * q - p - 3 * r + s) * t ** 3)
                              for p, q, r, s in zip(a, b, c, e)))
    return line + [points[-1]]


def vase(d):
    """Bellied, 0.28 m high; thick enough for glass."""
    return vessel(d, curve(d, [(0.045, 0), (0.075, 0.07), (0.07, 0.14), (0.035, 0.2), (0.034, 0.23), (0.052, 0.28)], 4), 0.006, 40)


def carafe(d):
    return vessel(d, curve(d, [(0.055, 0), (0.07, 0.05), (0.06, 0.11), (0.03, 0.17), (0.028, 0.21), (0.042, 0.25)], 5), 0.005, 56)


def tumbler(d):
    return vessel(d, [(0.03, 0), (0.034, 0.05), (0.038, 0.1)], 0.004, 48)


def bowl(d):
    return vessel(d, curve(d, [(0.055, 0), (0.06, 0.012), (0.11, 0.04), (0.145, 0.085), (0.155, 0.1)], 3), 0.008, 40)


def apple(d):
    """0.075 m high."""
    profile = [(0, 0.006), (0.012, 0.0), (0.026, 0.006), (0.038, 0.03), (0.038, 0.05), (0.026, 0.07), (0.012, 0.075), (0, 0.066)]
    line = curve(d, profile, 4)
    return d.lathe([(0 if p in (line[0], line[-1]) else max(p[0], 0.001), p[1]) for p in line], 28)


def burner(d):
    """What carries the lantern's light: a saucer and a thin stem up to y = 0.15."""
    return joined(d.lathe([(0, 0.038), (0.05, 0.038), (0.055, 0.048), (0.05, 0.043), (0.012, 0.046), (0.006, 0.06), (0, 0.06)], 24),
                  d.bar([(0, 0.055, 0), (0, 0.15, 0)], 0.002, 8))


def jar(d):
    """A big-shouldered clay vase, 0.4 m high."""
    return vessel(d, curve(d, [(0.06, 0), (0.1, 0.12), (0.13, 0.25), (0.09, 0.34), (0.05, 0.37), (0.07, 0.4)], 3), 0.01, 32)


def shade(d, bottom, top, height, wall=0.004):
    """An open, tapered lampshade, closed as a body; its lower rim is at y = 0."""
    outer = [(bottom + (top - bottom) * t, height * t) for t in steps(d.count(3, 1))]
    ring = outer + [(r - wall, y) for r, y in outer[::-1]]
    return d.lathe(ring + [ring[0]], 48)


def lamp_base(d):
    """A turned table lamp's foot, 0.34 m high."""
    profile = curve(d, [(0.075, 0), (0.078, 0.015), (0.03, 0.035), (0.06, 0.12), (0.05, 0.18), (0.016, 0.24), (0.012, 0.34)], 3)
    return d.lathe([(0, 0)] + profile + [(0, 0.34)], 32)


def floor_lamp_stand(d):
    """1.5 m high, with a heavy foot."""
    return d.lathe([(0, 0), (0.14, 0), (0.14, 0.02), (0.12, 0.03), (0.02, 0.045), (0.012, 0.07), (0.012, 1.5), (0, 1.5)], 24)


def shelf(d, width, height, boards):
    """An open bookcase, 0.28 m deep, its back at z = -0.14."""
    half = width / 2
    parts = [box((-half, 0, -0.14), (-half + 0.025, height, 0.14)), box((half - 0.025, 0, -0.14), (half, height, 0.14)),
             box((-half + 0.02, 0.03, -0.139), (half - 0.02, height - 0.01, -0.13)),
             d.block((-half - 0.015, height - 0.001, -0.14), (half + 0.015, height + 0.03, 0.155), 0.008, 2)]
    parts += [box((-half + 0.02, y - 0.022, -0.135), (half - 0.02, y, 0.133)) for y in shelf_heights(height, boards)]
    return joined(*parts)


def shelf_heights(height, boards):
    return [0.08 + i * (height - 0.08) / boards for i in range(boards)]


def shelved_books(d, width, height, boards, colours):
    """Books for shelf(), as one mesh for each of `colours`; rows end early or lean, as rows do."""
    random_ = random.Random(7)
    meshes = [Mesh() for _ in range(colours)]
    room = (height - 0.08) / boards - 0.03
    for y in shelf_heights(height, boards):
        x, end = -width / 2 + 0.03, width / 2 - 0.03 - 0.3 * random_.random()
        while True:
            thick = (0.018 + 0.034 * random_.random()) * (1 if d.fine else 6)
            tall, deep = room * (0.62 + 0.33 * random_.random()), 0.15 + 0.06 * random_.random()
            colour = int(random_.random() * colours)
            if x + thick > end:
                break
            book = book_block(thick, tall, deep)
            meshes[colour].add(book.moved(x + thick / 2, y + 0.0005, -0.125 + deep / 2))
            x += thick + 0.0008
    return meshes


def book_block(thick, tall, deep):
    """An upright book, its spine at +z."""
    return box((-thick / 2, 0, -deep / 2), (thick / 2, tall, deep / 2))


def frame(width, height, rim=0.035):
    """A picture frame that hangs at z = 0 and stands 0.025 m proud."""
    w, h = width / 2, height / 2
    return joined(board(rectangle(-w, -h, w, h), [rectangle(-w + rim, -h + rim, w - rim, h - rim)], 0.001, 0.025),
                  board(rectangle(-w + 0.008, -h + 0.008, w - 0.008, h - 0.008),
                        [rectangle(-w + 0.6 * rim, -h + 0.6 * rim, w - 0.6 * rim, h - 0.6 * rim)], 0.02, 0.03))


def pot(d):
    return vessel(d, [(0.1, 0), (0.13, 0.2), (0.135, 0.25), (0.15, 0.252), (0.15, 0.29)], 0.012, 36)


def soil(d):
    return d.lathe([(0, 0.05), (0.1, 0.05), (0.126, 0.245), (0.06, 0.252), (0, 0.255)], 24)


def foliage(d):
    """Long arching leaves out of pot(), 1.2 m high: thin sheets, folded along the middle, seen from both sides."""
    random_ = random.Random(11)
    plant = Mesh()
    for k in range(34 if d.fine else 5):
        turn, lean = 360 * (k * 0.618034 % 1), 0.15 + 0.75 * random_.random()
        length, width = 0.55 + 0.5 * random_.random(), 0.05 + 0.03 * random_.random()
        plant.add(arching_leaf(d.count(14, 2), length, width, lean).turned(turn).moved(0, 0.25, 0))
    return plant


def arching_leaf(pieces, length, width, lean):
    mesh = Mesh()
    for i in range(pieces + 1):
        t = i / pieces
        angle = math.pi / 2 - lean * (0.25 + 1.9 * t * t)
        x, y = mesh.positions[-2][:2] if i else (0.03, 0)
        along = (math.cos(angle), math.sin(angle))
        x, y = (x + along[0] * length / pieces, y + along[1] * length / pieces) if i else (x, y)
        half = width / 2 * (0.25 + 0.75 * math.sin(math.pi * min(1, t + 0.15))) * (1 - t ** 4) + 0.0005
        for side in (-1, 0, 1):
            lift = 0.35 * half * abs(side)
            mesh.positions.append((x - along[1] * lift, y + along[0] * lift, side * half))
            mesh.normals.append(unit((-along[1], along[0], -0.35 * side)))
    for i in range(pieces):
        a = 3 * i
        for s in (a, a + 1):
            mesh.triangles += [(s, s + 1, s + 4), (s, s + 4, s + 3)]
    return mesh


def curtain(d, width, height, folds):
    """Hangs from y = 0 in the plane z = 0, in folds; a thin sheet."""
    mesh, n = Mesh(), folds * d.count(12, 2)
    for i in range(n + 1):
        a = 2 * math.pi * folds * i / n
        x = width * (i / n - 0.5)
        slope = 0.035 * math.cos(a) * 2 * math.pi * folds / width
        for y in (0.0, -height):
            mesh.positions.append((x, y, 0.035 * math.sin(a)))
            mesh.normals.append(unit((-slope, 0, 1)))
    for i in range(n):
        a = 2 * i
        mesh.triangles += [(a, a + 1, a + 3), (a, a + 3, a + 2)]
    return mesh
