#!/usr/bin/env python3
"""Rooms that nobody tuned for: random interiors, every method and `auto` in each.

usage: bench/random_rooms.py [--keyhole build/keyhole] [--rooms 1-12] [--times 5,15] [--methods auto,path,bdpt,ipm]
                             [--resolution 128x96] [--reference-seconds 120] [--seed 1] [-j 2] [--out random_rooms]

Room N is made from the number N alone: its size, its windows (none, bare, with a pane, with blinds; to a sky, with or without a sun;
from 101 on also with a curtain or frosted glass),
its lamps (on the ceiling, spots, behind a shade, in a glass bulb, shining at the ceiling, in the next room with the door ajar;
from 101 on also in a globe, in frosted glass, a screen, a chandelier), its
furniture (from 1001 on also smooth meshes, fine and coarse ones, and uneven surfaces) and what it is made of (paint, wood under varnish, plastic, metal, glass, mirrors). Two long renders by `bdpt` are the
reference of each: with the sun behind glass they lack what mirrors show of it. Errors are trimmed squared relative ones free of the
references' noise (`keyhole diff`, cross_trim). The last columns: the brightness of the picture by `ipm` over that of the references,
and what the room has.
"""
import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import random
import statistics
import struct

from common import diff, render_for

ROOT = pathlib.Path(__file__).resolve().parent.parent


class Room:
    """One random interior. x: across, y: up, z: towards the eye's wall. Metres."""

    def __init__(self, number):
        self.rng, self.more, self.meshes = random.Random(number), number > 100, number > 1000
        self.shapes, self.emitters, self.told = [], [], []
        self.size = (self.rng.uniform(3, 7), self.rng.uniform(2.4, 3.4), self.rng.uniform(3.5, 9))

    def pick(self, *things):
        return self.rng.choice(things)

    def colour(self, least, most):
        return [round(self.rng.uniform(least, most), 3) for _ in range(3)]

    def shape(self, text):
        self.shapes.append("  - {" + text + "}")

    def box(self, low, high, material):
        self.shape(f"type: box, min: {[round(v, 4) for v in low]}, max: {[round(v, 4) for v in high]}, material: {material}")

    def material(self):
        """A random one of those that furniture has, in place."""
        if self.meshes and self.rng.random() < 0.4:
            return self.uneven()
        kind = self.pick("diffuse", "diffuse", "varnish", "plastic", "gloss", "metal", "rough metal")
        bright = self.colour(0.1, 0.75)
        return {"diffuse": f"{{type: diffuse, reflectance: {bright}}}",
                "varnish": f"{{type: coated_diffuse, reflectance: {bright}, roughness: {self.pick(0, 0.05, 0.2)}}}",
                "plastic": f"{{type: plastic, base_color: {bright}, roughness: {self.pick(0.1, 0.3, 0.6)}}}",
                "gloss": f"{{type: principled, base_color: {bright}, roughness: {self.pick(0.2, 0.5)}, clearcoat: {self.pick(0, 1)}}}",
                "metal": f"{{type: conductor, reflectance: {self.colour(0.6, 0.95)}, roughness: {self.pick(0, 0.02)}}}",
                "rough metal": f"{{type: conductor, reflectance: {self.colour(0.5, 0.9)}, roughness: {self.pick(0.1, 0.3)}}}"}[kind]

    def uneven(self):
        """Bumps, and the parameters of `principled` that the others leave alone."""
        noise = f"{{type: fbm, octaves: 4, transform: {{scale: {self.pick(0.02, 0.1)}}}}}"
        bump = f", bump: {{type: scale, texture: {noise}, factor: {self.pick(0.002, 0.01)}}}" if self.rng.random() < 0.6 else ""
        kind = self.pick("diffuse", "principled", "principled", "conductor", "coated_diffuse")
        rest = {"diffuse": f"reflectance: {self.colour(0.2, 0.8)}",
                "conductor": f"reflectance: {self.colour(0.5, 0.9)}, roughness: {self.pick(0.1, 0.3, 0.5)}",
                "coated_diffuse": f"reflectance: {self.colour(0.2, 0.8)}, roughness: {self.pick(0.05, 0.3)}",
                "principled": f"base_color: {self.colour(0.2, 0.9)}, roughness: {self.pick(0.1, 0.25, 0.5, 0.8)}, "
                              f"metallic: {self.pick(0, 0.5, 1)}, anisotropy: {self.pick(0, 0.6)}, sheen: {self.pick(0, 1)}"}[kind]
        return f"{{type: {kind}, {rest}{bump}}}"

    def mesh(self, base, size):
        """On `base`, at most `size` wide and high."""
        name = self.pick("armchair_cushions", "apple", "bowl", "cushion", "egg", "foliage", "jar", "kettle", "lamp_base", "pan", "vase")
        low, high = bounds(ROOT / f"scenes/meshes/{name}.ply")
        scale = size / max(b - a for a, b in zip(low, high))
        middle = [(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2]
        steps = [{"translate": [-x for x in middle]}, {"scale": scale}, {"rotate": [self.rng.uniform(0, 360), 0, 1, 0]}, {"translate": base}]
        self.shape(f"type: mesh, file: {ROOT}/scenes/meshes/{name}.ply, material: {self.material()}, transform: {json.dumps(steps)}")

    def coarse(self, base, size):
        """A ball of few facets with smooth normals."""
        self.shape(f"type: mesh, file: coarse_ball.ply, material: {self.material()}, "
                   f"transform: [{{scale: {size / 2}}}, {{translate: {[base[0], base[1] + size / 2, base[2]]}}}]")

    def walls(self, openings):
        """Six slabs 0.2 m thick. openings: {"left" | "back": (low u, low y, high u, high y)}, u along the wall."""
        w, h, d = self.size
        t = 0.2
        wall = self.material() if self.rng.random() < 0.15 else f"{{type: diffuse, reflectance: {self.colour(0.5, 0.8)}}}"
        floor = self.pick(f"{{type: diffuse, reflectance: {self.colour(0.2, 0.5)}}}",
                          f"{{type: principled, base_color: {self.colour(0.2, 0.5)}, roughness: {self.pick(0.2, 0.35, 0.5)}}}",
                          f"{{type: coated_diffuse, reflectance: {self.colour(0.2, 0.6)}, roughness: {self.pick(0, 0.1)}}}",
                          "{type: diffuse, reflectance: {type: checkerboard, a: 0.6, b: 0.15, repeat: [9, 9]}}")
        self.box((-t, -t, -t), (w + t, 0, d + t), floor)
        self.box((-t, h, -t), (w + t, h + t, d + t), "{type: diffuse, reflectance: 0.75}")
        self.box((w, 0, -t), (w + t, h, d + t), wall)
        self.box((-t, 0, d), (w, h, d + t), wall)
        for side, length in (("left", d), ("back", w)):
            def slab(u0, y0, u1, y1, side=side):
                if u1 > u0 and y1 > y0:
                    low, high = ((-t, y0, u0), (0, y1, u1)) if side == "left" else ((u0, y0, -t), (u1, y1, 0))
                    self.box(low, high, wall)
            if side not in openings:
                slab(0, 0, length, h)
                continue
            u0, y0, u1, y1 = openings[side]
            for part in ((0, 0, u0, h), (u1, 0, length, h), (u0, 0, u1, y0), (u0, y1, u1, h)):
                slab(*part)

    def window(self, side):
        w, h, d = self.size
        length = d if side == "left" else w
        u0, y0 = length * self.rng.uniform(0.1, 0.4), self.pick(0.1, 0.9)
        opening = (u0, y0, u0 + length * self.rng.uniform(0.25, 0.5), h - self.rng.uniform(0.2, 0.6))
        cover = self.pick("bare", "pane", "thick pane", "blinds", *(["curtain", "frosted"] * self.more))
        self.told.append(f"window ({cover})")
        at = (lambda u, y, n: (n, y, u)) if side == "left" else (lambda u, y, n: (u, y, n))
        a, b, c, e = opening
        if cover == "pane":
            u, v = [x - y for x, y in zip(at(c, b, 0), at(a, b, 0))], [0, e - b, 0]
            self.shape(f"type: rectangle, corner: {list(at(a, b, -0.1))}, u: {u}, v: {v}, material: {{type: thin_dielectric}}")
        if cover == "thick pane":
            self.box(at(a, b, -0.11), at(c, e, -0.1), "{type: glass}")
        if cover == "frosted":
            self.box(at(a, b, -0.11), at(c, e, -0.1), f"{{type: dielectric, roughness: {self.pick(0.1, 0.3)}}}")
        if cover == "curtain":
            folds = 14
            for i in range(folds):
                left, right = at(a + (c - a) * i / folds, b, -0.04), at(a + (c - a) * (i + 1) / folds, b, -0.04)
                bulge = at(0, 0, 0.03 if i % 2 else -0.03)
                corner = [x + y / 2 for x, y in zip(left, at(0, 0, 0.03 if i % 2 == 0 else -0.03))]
                along = [y - x + z for x, y, z in zip(left, right, bulge)]
                self.shape(f"type: rectangle, corner: {corner}, u: {along}, v: {[0, e - b, 0]}, "
                           "material: {type: diffuse_transmission, reflectance: 0.5, transmittance: 0.35}")
        if cover == "blinds":
            slats = 12
            for i in range(slats):
                y = b + (e - b) * (i + 0.5) / slats
                self.box(at(a, y - 0.004, -0.1), at(c, y + 0.004, -0.02), "{type: diffuse, reflectance: 0.7}")
        return opening

    def sky(self):
        self.emitters.append(f"  - {{type: environment, radiance: {self.colour(1, 2)}}}")
        if self.rng.random() < 0.5:
            self.told.append("sun")
            direction = [self.rng.uniform(0.3, 1), -self.rng.uniform(0.4, 1), self.rng.uniform(0.2, 1)]
            self.emitters.append(f"  - {{type: distant, direction: {direction}, irradiance: {self.pick(10, 40)}, angle: 0.53}}")

    def lamp(self):
        w, h, d = self.size
        x, z = w * self.rng.uniform(0.25, 0.75), d * self.rng.uniform(0.2, 0.7)
        kind = self.pick("panel", "spots", "shade", "bulb", "uplight", "row", "point",
                         *(["globe", "frosted bulb", "screen", "chandelier"] * self.more))
        self.told.append(kind)
        if kind == "panel":
            self.shape(f"type: rectangle, corner: {[x, h - 0.02, z]}, u: [0.5, 0, 0], v: [0, 0, 0.5], emission: {{power: 60}}")
        if kind == "point":
            self.emitters.append(f"  - {{type: point, position: {[x, h - 0.4, z]}, power: 60}}")
        if kind == "row":
            for i in range(6):
                self.shape(f"type: sphere, center: {[w * (i + 0.5) / 6, h - 0.1, z]}, radius: 0.04, emission: {{power: 10}}")
        if kind == "spots":
            for i in range(3):
                to = [self.rng.uniform(0, w), 0, self.rng.uniform(0, d)]
                self.emitters.append(f"  - {{type: spot, position: {[w * (i + 0.5) / 3, h - 0.05, z]}, to: {to}, "
                                     f"angle: {self.pick(20, 40)}, power: 20}}")
        if kind == "bulb":
            centre = [x, h - 0.6, z]
            self.shape(f"type: sphere, center: {centre}, radius: 0.02, emission: {{power: 60}}")
            self.shape(f"type: sphere, center: {centre}, radius: 0.06, material: {{type: glass}}")
            self.shape(f"type: sphere, center: {centre}, radius: 0.058, material: {{type: glass}}, flip: true")
        if kind in ("globe", "frosted bulb"):
            centre = [x, h - 0.6, z]
            self.shape(f"type: sphere, center: {centre}, radius: 0.03, emission: {{power: 60}}")
            cover = ("{type: diffuse_transmission, reflectance: 0.35, transmittance: 0.6}" if kind == "globe"
                     else "{type: dielectric, roughness: 0.3}")
            self.shape(f"type: sphere, center: {centre}, radius: 0.12, material: {cover}")
            if kind == "frosted bulb":
                self.shape(f"type: sphere, center: {centre}, radius: 0.117, material: {cover}, flip: true")
        if kind == "screen":
            self.shape(f"type: rectangle, corner: {[x, 0.8, 0.02]}, u: [1, 0, 0], v: [0, 0.6, 0], emission: {{power: 20}}")
        if kind == "chandelier":
            for i in range(40):
                angle, ring = 2 * math.pi * i / 40, 0.2 + 0.1 * (i % 3)
                at = [x + ring * math.cos(angle), h - 0.5 - 0.1 * (i % 4), z + ring * math.sin(angle)]
                self.shape(f"type: sphere, center: {at}, radius: 0.01, emission: {{power: 2}}")
        if kind == "shade":
            y = self.rng.uniform(1.2, 1.6)
            self.shape(f"type: sphere, center: {[x, y + 0.15, z]}, radius: 0.05, emission: {{power: 60}}")
            for u, v, corner in (([0.3, 0, 0], [0, 0.3, 0], [x - 0.15, y, z - 0.15]), ([0.3, 0, 0], [0, 0.3, 0], [x - 0.15, y, z + 0.15]),
                                 ([0, 0, 0.3], [0, 0.3, 0], [x - 0.15, y, z - 0.15]), ([0, 0, 0.3], [0, 0.3, 0], [x + 0.15, y, z - 0.15])):
                self.shape(f"type: rectangle, corner: {corner}, u: {u}, v: {v}, "
                           "material: {type: diffuse_transmission, reflectance: 0.4, transmittance: 0.4}")
        if kind == "uplight":
            self.box((x, 1.5, 0.02), (x + 0.5, 1.52, 0.3), "{type: diffuse, reflectance: 0.5}")
            self.shape(f"type: rectangle, corner: {[x + 0.05, 1.56, 0.05]}, u: [0, 0, 0.2], v: [0.4, 0, 0], emission: {{power: 60}}")

    def next_room(self, opening):
        """A lamp's room behind an opening of the back wall, with a door ajar in it."""
        a, b, c, e = opening
        h = self.size[1]
        gap = self.pick(0.02, 0.1, 0.4)
        self.told.append(f"door open {gap} m")
        self.box((a + gap, b, -0.12), (c, e, -0.08), "{type: plastic, base_color: 0.6, roughness: 0.3}")
        paint = "{type: diffuse, reflectance: 0.7}"
        self.box((a - 1.5, -0.2, -3.4), (c + 1.5, 0, -0.2), paint)
        self.box((a - 1.5, h, -3.4), (c + 1.5, h + 0.2, -0.2), paint)
        self.box((a - 1.7, 0, -3.4), (a - 1.5, h, -0.2), paint)
        self.box((c + 1.5, 0, -3.4), (c + 1.7, h, -0.2), paint)
        self.box((a - 1.5, 0, -3.4), (c + 1.5, h, -3.2), paint)
        self.shape(f"type: rectangle, corner: {[a, h - 0.02, -2]}, u: [0.5, 0, 0], v: [0, 0, 0.5], emission: {{power: 200}}")

    def furniture(self):
        w, h, d = self.size
        for _ in range(self.rng.randint(2, 5)):
            x, z = self.rng.uniform(0.2, w - 1.4), self.rng.uniform(0.3, d - 2.6)
            wide, deep, tall = self.rng.uniform(0.4, 1.2), self.rng.uniform(0.4, 1), self.rng.uniform(0.4, 0.9)
            material = self.material()
            if self.rng.random() < 0.5:
                self.box((x, 0, z), (x + wide, tall, z + deep), material)
            else:
                for i in (x, x + wide - 0.05):
                    for k in (z, z + deep - 0.05):
                        self.box((i, 0, k), (i + 0.05, tall - 0.04, k + 0.05), material)
                self.box((x, tall - 0.04, z), (x + wide, tall, z + deep), self.pick(material, "{type: dielectric}"))
            for _ in range(self.rng.randint(0, 3)):
                r = self.rng.uniform(0.05, 0.18)
                centre = [x + self.rng.uniform(0.2, 0.8) * wide, tall + r + 0.001, z + self.rng.uniform(0.2, 0.8) * deep]
                self.shape(f"type: sphere, center: {centre}, radius: {r}, material: {self.pick(self.material(), '{type: glass}')}")
            if self.meshes:
                self.pick(self.mesh, self.coarse)([x + wide / 2, tall + 0.001, z + deep / 2], self.rng.uniform(0.2, 0.5))
        if self.meshes:
            for _ in range(3):
                place = [self.rng.uniform(0.4, w - 0.4), 0.001, self.rng.uniform(0.4, d - 1.5)]
                self.pick(self.mesh, self.coarse)(place, self.rng.uniform(0.3, 0.8))
        if self.rng.random() < 0.4:
            self.told.append("mirror")
            self.shape(f"type: rectangle, corner: {[w - 0.02, 0.8, d * 0.3]}, u: [0, 0, 1.2], v: [0, 1.2, 0], material: {{type: mirror}}")

    def yaml(self):
        w, h, d = self.size
        light = self.pick("window", "window", "two windows", "lamps", "lamps", "window and lamps", "next room")
        openings = {}
        if light != "lamps":
            openings["back"] = (w * 0.4, 0, w * 0.4 + 0.9, 2.1) if light == "next room" else self.window("back")
        if light == "two windows" or (light == "window" and self.rng.random() < 0.6):
            if light == "window":
                openings.clear()
                self.told.clear()
                self.shapes.clear()
            openings["left"] = self.window("left")
        self.walls(openings)
        if "window" in light:
            self.sky()
        if "lamps" in light:
            for _ in range(self.rng.randint(1, 2)):
                self.lamp()
        if light == "next room":
            self.next_room(openings["back"])
        self.furniture()
        eye = [w * self.rng.uniform(0.15, 0.85), self.rng.uniform(1.2, 1.7), d - 0.3]
        to = [w * self.rng.uniform(0.3, 0.7), self.rng.uniform(0.7, 1.2), d * 0.2]
        head = ["# " + light + ": " + ", ".join(self.told), f"camera: {{from: {eye}, to: {to}, fov: {self.pick(45, 60, 75)}}}"]
        emitters = ["emitters:", *self.emitters] if self.emitters else []
        return "\n".join([*head, *emitters, "shapes:", *self.shapes]) + "\n"


def bounds(file):
    """Lowest and highest coordinates of a binary PLY whose vertices are floats, positions first."""
    data = file.read_bytes()
    head, _, body = data.partition(b"end_header\n")
    vertices = head.partition(b"element face")[0]
    count, width = int(vertices.split(b"element vertex ")[1].split()[0]), vertices.count(b"property float")
    points = [struct.unpack_from("<3f", body, 4 * width * i) for i in range(count)]
    return [min(p) for p in zip(*points)], [max(p) for p in zip(*points)]


def write_coarse_ball(file, across=8, down=5):
    """A unit ball of 8 x 5 facets with its own normals."""
    points = [(math.sin(math.pi * j / down) * math.cos(2 * math.pi * i / across), math.cos(math.pi * j / down),
               math.sin(math.pi * j / down) * math.sin(2 * math.pi * i / across)) for j in range(down + 1) for i in range(across)]
    faces = []
    for j in range(down):
        for i in range(across):
            a, b, k = j * across + i, j * across + (i + 1) % across, across
            faces += [f"3 {a} {b} {b + k}"] * (j > 0) + [f"3 {a} {b + k} {a + k}"] * (j < down - 1)
    head = ["ply", "format ascii 1.0", f"element vertex {len(points)}", *(f"property float {c}" for c in ("x", "y", "z", "nx", "ny", "nz")),
            f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    file.write_text("\n".join([*head, *(" ".join(f"{c:.6f}" for c in 2 * p) for p in points), *faces]) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=str(ROOT / "build/keyhole"))
    parser.add_argument("--rooms", default="1-12", help="numbers, or FIRST-LAST")
    parser.add_argument("--times", default="5,15")
    parser.add_argument("--methods", default="auto,path,bdpt,ipm")
    parser.add_argument("--resolution", default="128x96")
    parser.add_argument("--reference-seconds", type=float, default=120)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--out", default="random_rooms")
    args = parser.parse_args()
    out = pathlib.Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    write_coarse_ball(out / "coarse_ball.ply")
    first, _, last = args.rooms.partition("-")
    rooms = list(range(int(first), int(last or first) + 1)) if "," not in args.rooms else [int(n) for n in args.rooms.split(",")]
    times, methods = [float(t) for t in args.times.split(",")], args.methods.split(",")
    told, found = {}, {}
    for n in rooms:
        text = Room(n).yaml()
        (out / f"{n}.yaml").write_text(text)
        told[n] = text.partition("\n")[0].removeprefix("# ")

    def references(n):
        return [out / f"{n}.{x}.exr" for x in "ab"]

    def measure(n, seconds, method):
        picture = out / f"{n}-{seconds:g}-{method}.exr"
        stats = pathlib.Path(f"{picture}.json")
        render_for(args.keyhole, out / f"{n}.yaml", seconds, method, args.seed, args.resolution, picture, "--stats", str(stats))
        chosen = json.loads(stats.read_text())["method"]
        found[n, seconds, method] = diff(args.keyhole, picture, *references(n)) | {"method": chosen}

    def reference(n, picture, seed):
        render_for(args.keyhole, out / f"{n}.yaml", args.reference_seconds, "bdpt", seed, args.resolution, picture)

    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        missing = [(n, p, 101 + i) for n in rooms for i, p in enumerate(references(n)) if not p.exists()]
        list(pool.map(lambda m: reference(*m), missing))
        list(pool.map(lambda m: measure(*m), [(n, t, m) for n in rooms for t in times for m in methods]))

    print("| room | s | " + " | ".join(methods) + " | auto over best | ipm's mean | |\n" + "| --- " * (len(methods) + 5) + "|")
    ratios = []
    for n in rooms:
        halves = diff(args.keyhole, *references(n))
        for t in times:
            row = {m: found[n, t, m] for m in methods}
            best = min(row[m]["cross_trim"] for m in methods if m != "auto")
            ratio = row["auto"]["cross_trim"] / best if "auto" in row else float("nan")
            ratios.append(ratio)
            cells = [f"{r['cross_trim']:.2g}" + (f" ({r['method']})" if m == "auto" else "") for m, r in row.items()]
            mean = f"{row['ipm']['ratio']:.3f}" if "ipm" in row else "-"
            note = f"{told[n]}; references {halves['ratio']:.3f}" if t == times[0] else ""
            print(f"| {n} | {t:g} | " + " | ".join(cells) + f" | {ratio:.2f} | {mean} | {note} |")
    print(f"\nauto over best: median {statistics.median(ratios):.2f}, largest {max(ratios):.2f}")


if __name__ == "__main__":
    main()
