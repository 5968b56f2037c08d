"""Bodies of the scenes that follow those of papers on Metropolis light transport."""

import math

from .detail import Detail
from .mesh import Mesh, unit
from .solids import lathe


def egg(d: Detail):
    """Stands upright, its tip on top; 0.11 m high."""
    count = d.count(48, 8)
    half, width, taper = 0.055, 0.04, 0.18
    angles = [math.pi * i / count for i in range(count + 1)]
    profile = [(width * math.sin(a) * (1 + taper * math.cos(a)), half - half * math.cos(a)) for a in angles]
    return lathe([(0.0, 0.0)] + profile[1:-1] + [(0.0, 2 * half)], 64)


def uplight(d: Detail):
    """The bowl of a lamp that shines upwards: open on top, thick, 0.36 m wide; its stand reaches down to y = 0."""
    curve = [(0.05 + 0.13 * math.sin(a), 1.62 - 0.12 * math.cos(a)) for a in
             [math.pi / 2 * i / 12 for i in range(13)]]
    outside = [(0, 0), (0.14, 0), (0.14, 0.02), (0.012, 0.03), (0.012, 1.49)]
    inside = [(r - 0.006, y + 0.004) for r, y in reversed(curve)]
    return lathe(outside + curve + inside + [(0, inside[-1][1])], d.count(48, 8))


def disco_facets():
    """The 80 facets of an icosahedron whose faces are cut in four, on the unit sphere, anticlockwise from outside."""
    g = (1 + math.sqrt(5)) / 2
    corners = [unit(p) for p in ((-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g),
                                 (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1))]
    faces = ((0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
             (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
             (8, 6, 7), (9, 8, 1))
    facets = []
    for a, b, c in ([corners[i] for i in f] for f in faces):
        ab, bc, ca = (unit(tuple(u + v for u, v in zip(p, q))) for p, q in ((a, b), (b, c), (c, a)))
        facets += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return facets


def disco_ball(radius):
    """The ball, of glass: closed and flat-sided."""
    mesh, index = Mesh(), {}
    for facet in disco_facets():
        for p in facet:
            index.setdefault(p, len(index))
        mesh.triangles.append(tuple(index[p] for p in facet))
    mesh.positions = [tuple(radius * v for v in p) for p in index]
    return mesh


def disco_mirrors(radius, gap):
    """Mirrors before every second facet, `gap` outside it."""
    mesh = Mesh()
    for i, facet in enumerate(disco_facets()):
        if i % 2:
            continue
        middle = unit(tuple(sum(p[k] for p in facet) for k in range(3)))
        first = len(mesh.positions)
        mesh.positions += [tuple(radius * v + gap * m for v, m in zip(p, middle)) for p in facet]
        mesh.triangles.append((first, first + 1, first + 2))
    return mesh
