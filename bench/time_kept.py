#!/usr/bin/env python3
"""Whether renders use the time that they are given, and no more.

usage: bench/time_kept.py [--keyhole build/keyhole] [--shared ../shared] [--times 2,10,40] [--method auto] [--heavy] [--stop]
                          [--scenes NAME,...] [-j 1]

Renders the ten scenes of bench/outside.py by --cpu-time, one thread, and prints for each the seconds that it took to load and the
seconds after that, over those that it was given. --heavy takes a scene that is made for it instead: a mesh of 5 million triangles,
20,000 instances, 2,000 lamps and an environment of as many pixels as 16,384 x 8,192. --stop sends SIGTERM at several moments instead and prints
how long the answer took and what was left; the exit code is 1 if a picture is missing, or if a share is below 0.93 or above 1.05.
Writing the picture counts as rendering.
"""
import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib

from outside import ROOT, SCENES, scene_file


def write_ply(path, vertices, faces):
    """Binary PLY from packed float and index arrays."""
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices) // 3}\nproperty float x\nproperty float y\n"
                   f"property float z\nelement face {len(faces) // 3}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        file.write(struct.pack(f"<{len(vertices)}f", *vertices))
        for i in range(0, len(faces), 3):
            file.write(struct.pack("<B3i", 3, *faces[i:i + 3]))


def write_png(path, side):
    """A square picture whose rows get brighter."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    packer = zlib.compressobj(1)
    rows = b"".join(packer.compress(b"\0" + bytes((60, 90, 60 + 150 * y // side)) * side) for y in range(side)) + packer.flush()
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", side, side, 8, 2, 0, 0, 0)) + chunk(b"IDAT", rows)
                     + chunk(b"IEND", b""))


def write_heavy(folder, side=1581, instances=141, lamps=2000, sky=11584):
    """Hills of 2 (side)^2 triangles, small pyramids on them, lamps above, under a large sky. Returns the scene file."""
    height = [[math.sin(0.013 * x) * math.cos(0.011 * y) + 0.1 * math.sin(0.31 * x + 0.17 * y) for x in range(side + 1)] for y in range(side + 1)]
    vertices = [c for y in range(side + 1) for x in range(side + 1) for c in (20 * x / side - 10, height[y][x], 20 * y / side - 10)]
    faces = []
    for y in range(side):
        for x in range(side):
            a = y * (side + 1) + x
            faces += [a, a + side + 1, a + 1, a + 1, a + side + 1, a + side + 2]
    write_ply(folder / "hills.ply", vertices, faces)
    write_png(folder / "sky.png", sky)
    lines = ['LookAt 0 4 -12  0 0 0  0 1 0', 'Camera "perspective" "float fov" 45', 'Film "rgb" "integer xresolution" 320 "integer yresolution" 240',
             'WorldBegin', 'LightSource "infinite" "string filename" "sky.png"', 'Material "diffuse" "rgb reflectance" [0.5 0.5 0.4]',
             'Shape "plymesh" "string filename" "hills.ply"', 'ObjectBegin "pyramid"',
             'Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 0 3 1] "point3 P" [0 .2 0 .05 0 .05 -.05 0 .05 0 0 -.05]', 'ObjectEnd']
    for i in range(instances ** 2):
        x, z = (i % instances) / instances * 18 - 9, (i // instances) / instances * 18 - 9
        lines.append(f'AttributeBegin Translate {x:.3f} 1.3 {z:.3f} ObjectInstance "pyramid" AttributeEnd')
    for i in range(lamps):
        x, z = 9 * math.sin(12.9898 * i), 9 * math.sin(78.233 * i + 1)
        lines.append(f'AttributeBegin AreaLightSource "diffuse" "rgb L" [20 18 15] Translate {x:.3f} 2 {z:.3f} '
                     'Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [0 0 0 .05 0 0 0 0 .05] AttributeEnd')
    (folder / "heavy.pbrt").write_text("\n".join(lines) + "\n")
    return folder / "heavy.pbrt"


def command(args, scene, size, picture, *options):
    return [args.keyhole, "render", scene, "-q", "-t", "1", "-o", picture, "--method", args.method,
            *(("--resolution", size) if size else ()), *options]


def measure(args, folder, name, scene, size, seconds):
    picture = folder / f"{name.replace('/', '-')}-{seconds:g}.exr"
    child = subprocess.Popen(command(args, scene, size, picture, "--cpu-time", f"{seconds:g}", "--stats", f"{picture}.json"))
    usage = os.wait4(child.pid, 0)
    if usage[1] != 0:
        print(f"{name:15}{seconds:>6g}  status {usage[1]}", flush=True)
        return False
    stats = json.loads(pathlib.Path(f"{picture}.json").read_text())
    loading = next(s["cpu_seconds"] for s in stats["stages"] if s["name"] == "loading")
    used = usage[2].ru_utime + usage[2].ru_stime - loading
    print(f"{name:15}{seconds:>6g} s  loading {loading:6.2f}  after that {used:7.2f}  share {used / seconds:.3f}  {stats['method']}", flush=True)
    return 0.93 <= used / seconds <= 1.05 or abs(used - seconds) <= 1 and used >= 0.93 * seconds


def stopped(args, folder, name, scene, size, after):
    picture = folder / "stopped.exr"
    picture.unlink(missing_ok=True)
    child = subprocess.Popen(command(args, scene, size, picture), stderr=subprocess.DEVNULL)
    time.sleep(after)
    if child.poll() is not None:
        return True
    child.send_signal(signal.SIGTERM)
    start = time.monotonic()
    status = child.wait()
    took = time.monotonic() - start
    print(f"{name:15} stopped after {after:5.1f} s: answered after {took:.2f} s, status {status}, "
          f"{'a picture' if picture.exists() else 'NOTHING'}", flush=True)
    return picture.exists()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=str(ROOT / "build/keyhole"))
    parser.add_argument("--shared", default=str(ROOT.parent / "shared"))
    parser.add_argument("--times", default="2,10,40")
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--method", default="auto")
    parser.add_argument("--heavy", action="store_true")
    parser.add_argument("--stop", action="store_true")
    parser.add_argument("-j", "--jobs", type=int, default=1)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        scenes = [("heavy", write_heavy(folder), None)] if args.heavy else [(n, scene_file(args.shared, n), SCENES[n][0])
                                                                             for n in args.scenes.split(",")]
        with concurrent.futures.ThreadPoolExecutor(1 if args.stop else args.jobs) as pool:
            if args.stop:
                jobs = [(name, file, size, after) for name, file, size in scenes for after in (0.7, 1.5, 3, 6)]
                good = list(pool.map(lambda j: stopped(args, folder, *j), jobs))
            else:
                jobs = [(name, file, size, float(t)) for name, file, size in scenes for t in args.times.split(",")]
                good = list(pool.map(lambda j: measure(args, folder, *j), jobs))
    sys.exit(0 if all(good) else 1)


if __name__ == "__main__":
    main()
