"""Flat pieces with holes: triangulated, and thickened to boards."""

import math

from .mesh import Mesh


def area(points):
    """Signed; positive where the points run anticlockwise."""
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1])) / 2


def _turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _inside(p, a, b, c):
    return _turn(a, b, p) >= 0 and _turn(b, c, p) >= 0 and _turn(c, a, p) >= 0


def _cross(a, b, c, d):
    """Whether two segments meet other than in a common end."""
    if a in (c, d) or b in (c, d):
        return False
    return _turn(a, b, c) * _turn(a, b, d) <= 0 and _turn(c, d, a) * _turn(c, d, b) <= 0


def _bridge(loop, hole, points, others):
    """Joins a hole to the loop around it by the shortest cut that meets no edge."""
    edges = [(l[i - 1], l[i]) for l in [loop, hole] + others for i in range(len(l))]
    cuts = sorted(((points[a][0] - points[b][0]) ** 2 + (points[a][1] - points[b][1]) ** 2, i, j)
                  for i, a in enumerate(loop) for j, b in enumerate(hole))
    for _, i, j in cuts:
        p, q = points[loop[i]], points[hole[j]]
        if not any(_cross(p, q, points[a], points[b]) for a, b in edges):
            return loop[:i + 1] + hole[j:] + hole[:j + 1] + loop[i:]
    raise ValueError('the hole lies outside, or holes overlap')


def triangulate(outer, holes=()):
    """Ear clipping. `outer` runs anticlockwise; returns (points, triangles)."""
    points, loops = [], []
    for contour in [outer] + [list(h) for h in holes]:
        if (area(contour) > 0) != (contour is outer):
            contour = contour[::-1]
        loops.append(list(range(len(points), len(points) + len(contour))))
        points += contour
    loop, rest = loops[0], loops[1:]
    while rest:
        hole = rest.pop(0)
        loop = _bridge(loop, hole, points, rest)

    triangles = []
    while len(loop) > 3:
        best = None
        for i in range(len(loop)):
            ia, ib, ic = loop[i - 1], loop[i], loop[(i + 1) % len(loop)]
            a, b, c = points[ia], points[ib], points[ic]
            if _turn(a, b, c) <= 1e-14:
                continue
            if any(_inside(points[k], a, b, c) for k in loop if points[k] not in (a, b, c)):
                continue
            longest = max(math.dist(a, b), math.dist(b, c), math.dist(c, a))
            quality = _turn(a, b, c) / longest ** 2  # the roundest ear first: few slivers
            if best is None or quality > best[0]:
                best = (quality, i, (ia, ib, ic))
        if best is None:
            raise ValueError('no ear: the outline crosses itself')
        triangles.append(best[2])
        del loop[best[1]]
    return points, triangles + [tuple(loop)]


def board(outer, holes, z0, z1):
    """An outline in the xy plane, pierced by holes, between two depths: closed and flat-sided."""
    points, triangles = triangulate(outer, holes)
    mesh, count = Mesh(), len(points)
    mesh.positions = [(x, y, z1) for x, y in points] + [(x, y, z0) for x, y in points]
    mesh.triangles = list(triangles) + [(count + a, count + c, count + b) for a, b, c in triangles]
    first = 0
    for contour in [outer] + list(holes):
        n = len(contour)
        for i in range(n):
            a, b = first + i, first + (i + 1) % n
            mesh.triangles += [(a, count + a, count + b), (a, count + b, b)]
        first += n
    return mesh


def sheet(outer, holes=()):
    """The front of a board only, facing +z."""
    mesh = Mesh()
    points, mesh.triangles = triangulate(outer, holes)
    mesh.positions = [(x, y, 0.0) for x, y in points]
    return mesh


def rectangle(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def star(x, y, outer, inner, points, turn=90.0):
    return [(x + r * math.cos(a), y + r * math.sin(a))
            for i in range(2 * points)
            for r, a in [((outer, inner)[i % 2], math.radians(turn) + math.pi * i / points)]]


def circle(x, y, radius, points):
    return star(x, y, radius, radius, points // 2)


def leaf(x, y, length, width, turn, points):
    """Pointed at both ends; `points` along each side."""
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    side = [(length * (i / points - 0.5), width / 2 * math.sin(math.pi * i / points)) for i in range(points)]
    rim = [(u, -v) for u, v in side] + [(-u, v) for u, v in side]
    return [(x + c * u - s * v, y + s * u + c * v) for u, v in rim]
