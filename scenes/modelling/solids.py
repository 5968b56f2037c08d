"""Closed bodies: boxes, rounded boxes, bodies of revolution, tubes along a curve."""

import math

from .mesh import Mesh, cross, sub, unit


def box(lower, upper):
    """Axis-aligned, with sharp edges."""
    mesh = Mesh()
    mesh.positions = [tuple((lower, upper)[i >> axis & 1][axis] for axis in range(3)) for i in range(8)]
    for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
        mesh.triangles += [(a, b, c), (a, c, d)]
    return mesh


def rounded_box(lower, upper, radius, segments=2, inner=1, puff=0.0):
    """A box with edges rounded by `radius`, smooth. `puff` swells its top and bottom in the middle [m], like a cushion;
    that wants some `inner` segments across its faces."""
    middle = [(a + b) / 2 for a, b in zip(lower, upper)]
    half = [(b - a) / 2 for a, b in zip(lower, upper)]

    def ticks(h):
        # Tangents, so that the bevel is cut into equal angles once it has been pushed onto its circle.
        bevel = [h - radius + radius * math.tan(math.pi / 4 * i / segments) for i in range(segments, 0, -1)]
        core = [(h - radius) * (2 * i / inner - 1) for i in range(inner + 1)]
        return [-b for b in bevel] + core + bevel[::-1]

    mesh, index = Mesh(), {}

    def vertex(p):
        key = tuple(round(v, 9) for v in p)
        if key in index:
            return index[key]
        core = tuple(max(-(h - radius), min(h - radius, v)) for v, h in zip(p, half))
        n = unit(sub(p, core))
        swell = puff * (1 - (core[0] / half[0]) ** 2) * (1 - (core[2] / half[2]) ** 2) * n[1]
        index[key] = len(mesh.positions)
        mesh.positions.append(tuple(m + c + radius * v + (swell if axis == 1 else 0)
                                    for axis, (m, c, v) in enumerate(zip(middle, core, n))))
        if puff and abs(n[1]) > 0.99:
            slope = [-2 * puff * core[a] / half[a] ** 2 * (1 - (core[2 - a] / half[2 - a]) ** 2) for a in (0, 2)]
            n = unit((-slope[0], math.copysign(1, n[1]), -slope[1]))
        mesh.normals.append(n)
        return index[key]

    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        us, vs = ticks(half[u]), ticks(half[v])
        for side in (-1, 1):
            for i in range(len(us) - 1):
                for j in range(len(vs) - 1):
                    corners = []
                    for s, t in ((us[i], vs[j]), (us[i + 1], vs[j]), (us[i + 1], vs[j + 1]), (us[i], vs[j + 1])):
                        p = [0, 0, 0]
                        p[axis], p[u], p[v] = side * half[axis], s, t
                        corners.append(vertex(tuple(p)))
                    a, b, c, d = corners if side > 0 else corners[::-1]
                    mesh.triangles += [(a, b, c), (a, c, d)]
    return mesh


def lathe(profile, segments, crease=35.0):
    """Revolves (radius, height) points around the y axis; the outside is on the right of the profile's direction of
    travel when it climbs. A profile that starts and ends on the axis, or ends where it starts, makes a closed body.
    Corners sharper than `crease` degrees stay sharp."""
    mesh = Mesh()
    closed = profile[0] == profile[-1] and profile[0][0] > 0
    edges = [unit((b[1] - a[1], a[0] - b[0], 0.0)) for a, b in zip(profile, profile[1:])]
    limit = math.cos(math.radians(crease))

    def ring_normal(edge, neighbour):
        """Normal at the end of `edge` that it shares with `neighbour`, which may be missing."""
        if neighbour is None or sum(a * b for a, b in zip(edges[edge], edges[neighbour])) < limit:
            return edges[edge]
        return unit(tuple(a + b for a, b in zip(edges[edge], edges[neighbour])))

    rings = {}

    def ring(point, normal):
        key = (point, tuple(round(v, 9) for v in normal))
        if key not in rings:
            rings[key] = len(mesh.positions)
            for k in range(segments):
                c, s = math.cos(2 * math.pi * k / segments), math.sin(2 * math.pi * k / segments)
                mesh.positions.append((point[0] * c, point[1], -point[0] * s))
                mesh.normals.append((normal[0] * c, normal[1], -normal[0] * s))
        return rings[key]

    count = len(edges)
    for e in range(count):
        before = e - 1 if e > 0 else (count - 1 if closed else None)
        after = e + 1 if e + 1 < count else (0 if closed else None)
        (r0, _), (r1, _) = profile[e], profile[e + 1]
        a = ring(profile[e], edges[e] if r0 == 0 else ring_normal(e, before))
        b = ring(profile[e + 1], edges[e] if r1 == 0 else ring_normal(e, after))
        for k in range(segments):
            n = (k + 1) % segments
            if r0 > 0:
                mesh.triangles.append((a + k, a + n, b + n))
            if r1 > 0:
                mesh.triangles.append((a + k, b + n, b + k))
    return mesh


def cylinder(radius, y0, y1, segments):
    return lathe([(0, y0), (radius, y0), (radius, y1), (0, y1)], segments)


def tube(points, radius, segments, closed=False):
    """A round bar along a curve in space; `radius` is a number, or one for each point. Ends are capped."""
    radii = radius if isinstance(radius, (list, tuple)) else [radius] * len(points)
    mesh, count = Mesh(), len(points)
    side = None
    for i, p in enumerate(points):
        before, after = (points[i - 1], points[(i + 1) % count]) if closed else \
                        (points[max(i - 1, 0)], points[min(i + 1, count - 1)])
        along = unit(sub(after, before))
        if side is None:
            side = unit(cross(along, (0, 0, 1) if abs(along[2]) < 0.9 else (1, 0, 0)))
        lift = sum(a * s for a, s in zip(along, side))  # carried along without twist
        side = unit(tuple(s - lift * a for s, a in zip(side, along)))
        other = cross(along, side)
        for k in range(segments):
            c, s = math.cos(2 * math.pi * k / segments), math.sin(2 * math.pi * k / segments)
            n = tuple(c * u + s * v for u, v in zip(side, other))
            mesh.positions.append(tuple(q + radii[i] * v for q, v in zip(p, n)))
            mesh.normals.append(n)
    for i in range(count if closed else count - 1):
        a, b = i * segments, (i + 1) % count * segments
        for k in range(segments):
            n = (k + 1) % segments
            mesh.triangles += [(a + k, a + n, b + n), (a + k, b + n, b + k)]
    if not closed:
        last = (count - 1) * segments
        for k in range(1, segments - 1):
            mesh.triangles += [(0, k + 1, k), (last, last + k, last + k + 1)]
    return mesh
