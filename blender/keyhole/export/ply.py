"""Meshes as PLY files (Turk 1994), binary, one vertex for each corner of a triangle: flat faces and seams need no more."""

import os

import numpy as np

COLUMNS = "x", "y", "z", "nx", "ny", "nz", "u", "v"


def write(path, columns):
    """`columns`: (corners, 3, 6 or 8) numbers: position, normal, texture coordinates."""
    corners, width = columns.shape
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {corners}"]
    head += [f"property float {name}" for name in COLUMNS[:width]]
    head += [f"element face {corners // 3}", "property list uchar int vertex_indices", "end_header\n"]
    faces = np.empty(corners // 3, [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = np.arange(corners).reshape(-1, 3)
    with open(path, "wb") as file:
        file.write("\n".join(head).encode())
        np.ascontiguousarray(columns, "<f4").tofile(file)
        faces.tofile(file)
    return os.path.basename(path)


def filled(count, width, collection, attribute, kind):
    """An attribute of all elements of one of Blender's collections: (count, width)."""
    values = np.empty(count * width, kind)
    collection.foreach_get(attribute, values)
    return values.reshape(count, width)


def uv_map(mesh):
    """The layer of texture coordinates that renders use; None: there is none."""
    return next((layer for layer in mesh.uv_layers if layer.active_render), None)


def by_material(mesh):
    """{slot: columns of its triangles} of one of Blender's meshes."""
    if hasattr(mesh, "calc_normals_split"):  # until Blender 4.0
        mesh.calc_normals_split()
    mesh.calc_loop_triangles()
    triangles, loops = mesh.loop_triangles, mesh.loops
    corners = filled(len(triangles), 3, triangles, "loops", np.int32)
    slots = filled(len(triangles), 1, triangles, "material_index", np.int32)[:, 0]
    positions = filled(len(mesh.vertices), 3, mesh.vertices, "co", np.float32)
    vertices = filled(len(loops), 1, loops, "vertex_index", np.int32)[:, 0]
    values = [positions[vertices], filled(len(loops), 3, loops, "normal", np.float32)]
    layer = uv_map(mesh)
    if layer is not None:
        values.append(filled(len(loops), 2, layer.data, "uv", np.float32))
    of_loops = np.concatenate(values, 1)
    return {int(slot): of_loops[corners[slots == slot].reshape(-1)] for slot in np.unique(slots)}
