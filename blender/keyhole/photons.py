"""Photons of a map that `keyhole render --save-map` wrote, as a mesh of points with their colours."""

import struct

import bpy
import numpy as np

HEADER = struct.Struct("<8sIIQqq4QQ2iQ")
VERSION = 11
PHOTON = np.dtype([("position", "<f4", 3), ("power", "<u2", 3), ("direction", "<i2", 2), ("normal", "i1", 2)])
BITS, BIAS = 12, 80  # of the shared exponent: see src/photonmap/photon.h
NAME = "Keyhole Photons"


def read(path):
    """Positions (n, 3), and powers (n, 3) over their mean: what the file has is before division by the paths. Raises ValueError for files of other kinds."""
    with open(path, "rb") as file:
        data = file.read()
    if len(data) < HEADER.size:
        raise ValueError("found no photon map")
    magic, _, version, _, _, _, *counts, _, _, _, _ = HEADER.unpack_from(data)
    if magic != b"KHPHOTON" or version != VERSION:
        raise ValueError(f"found a photon map of version {version}, expected version {VERSION}")
    photons = np.frombuffer(data, PHOTON, sum(counts), HEADER.size)
    words = photons["power"].astype(np.int64)
    exponent = (words[:, 0] >> BITS | (words[:, 1] >> BITS & 7) << 4) - BIAS - BITS  # the rest are marks
    powers = (words & ((1 << BITS) - 1)) * np.exp2(exponent)[:, None]
    return photons["position"], powers / max(powers.mean(), 1e-300) if len(powers) else powers


def show(path, most):
    """Puts at most so many into the scene, in the place of those shown before. Returns the object."""
    positions, powers = read(path)
    chosen = np.random.default_rng(1).permutation(len(positions))[:most]
    mesh = bpy.data.meshes.new(NAME)
    mesh.vertices.add(len(chosen))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(positions[chosen], np.float32).ravel())
    colours = np.ones((len(chosen), 4), np.float32)
    colours[:, :3] = powers[chosen]
    mesh.attributes.new("power", "FLOAT_COLOR", "POINT").data.foreach_set("color", colours.ravel())
    mesh.update()
    thing = bpy.data.objects.get(NAME)
    if thing is None:
        thing = bpy.data.objects.new(NAME, mesh)
        thing.hide_render = True
        bpy.context.scene.collection.objects.link(thing)
    else:
        old, thing.data = thing.data, mesh
        bpy.data.meshes.remove(old)
    return thing
