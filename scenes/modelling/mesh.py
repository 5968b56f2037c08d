"""Triangle meshes: built up from parts, moved about, written as binary PLY."""

import math
import struct


class Mesh:
    """Indexed triangles. Either every vertex has a normal (unit) or `normals` is empty: flat."""

    def __init__(self):
        self.positions = []
        self.normals = []
        self.triangles = []

    def add(self, other):
        """Appends a mesh. A flat part in a smooth mesh gets the normals of its triangles, and so stays flat."""
        if self.positions and bool(self.normals) != bool(other.normals):
            for mesh in (self, other := other.copy()):
                if not mesh.normals:
                    mesh.split_flat()
        first = len(self.positions)
        self.positions += other.positions
        self.normals += other.normals
        self.triangles += [tuple(first + i for i in t) for t in other.triangles]
        return self

    def copy(self):
        mesh = Mesh()
        mesh.positions, mesh.normals, mesh.triangles = list(self.positions), list(self.normals), list(self.triangles)
        return mesh

    def split_flat(self):
        """Gives each triangle corners and normals of its own."""
        positions, normals = [], []
        for t in self.triangles:
            corners = [self.positions[i] for i in t]
            positions += corners
            normals += [unit(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])))] * 3
        self.positions, self.normals = positions, normals
        self.triangles = [(i, i + 1, i + 2) for i in range(0, len(positions), 3)]

    def without_normals(self):
        mesh = self.copy()
        mesh.normals = []
        return mesh

    def moved(self, x=0.0, y=0.0, z=0.0):
        mesh = self.copy()
        mesh.positions = [(p[0] + x, p[1] + y, p[2] + z) for p in mesh.positions]
        return mesh

    def turned(self, degrees, axis='y'):
        """Rotated about an axis through the origin, anticlockwise as seen from where the axis points to."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        turn = {'x': lambda p: (p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]),
                'y': lambda p: (c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]),
                'z': lambda p: (c * p[0] - s * p[1], s * p[0] + c * p[1], p[2])}[axis]
        mesh = self.copy()
        mesh.positions, mesh.normals = [turn(p) for p in mesh.positions], [turn(n) for n in mesh.normals]
        return mesh

    def write_ply(self, path):
        vertex = '\n'.join(f'property float {c}' for c in (('x', 'y', 'z', 'nx', 'ny', 'nz') if self.normals else 'xyz'))
        header = (f'ply\nformat binary_little_endian 1.0\nelement vertex {len(self.positions)}\n{vertex}\n'
                  f'element face {len(self.triangles)}\nproperty list uchar uint vertex_indices\nend_header\n')
        with open(path, 'wb') as out:
            out.write(header.encode('ascii'))
            for i, p in enumerate(self.positions):
                # Rounded, so that the file doesn't depend on the last bits of this machine's sines.
                values = [rounded(v, 6) for v in p] + [rounded(v, 4) for v in (self.normals[i] if self.normals else ())]
                out.write(struct.pack(f'<{len(values)}f', *values))
            for t in self.triangles:
                out.write(struct.pack('<B3I', 3, *t))


def rounded(value, digits):
    return round(value, digits) + 0.0  # no -0


def joined(*meshes):
    mesh = Mesh()
    for m in meshes:
        mesh.add(m)
    return mesh


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    return (a[0] / length, a[1] / length, a[2] / length)
