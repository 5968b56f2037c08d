"""Objects and their instances: a mesh file for each material slot, a group where there are several copies."""

import os

from . import ply

GEOMETRY = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
NOTHING_TO_SEE = {"ARMATURE", "CAMERA", "EMPTY", "LATTICE", "LIGHT_PROBE", "SPEAKER"}
RAYS = "camera", "diffuse", "glossy", "shadow", "transmission"


def rows(matrix):
    return [{"matrix": [x for row in matrix for x in row]}]


def identity(thing, is_instance):
    """Objects with the same are the same shape. Meshes that objects share look alike unless something changes them."""
    original = thing.original
    if original.type == "MESH" and not original.modifiers and not original.data.shape_keys:
        materials = tuple(slot.material.name if slot.material else "" for slot in original.material_slots)
        return original.data.name_full, materials
    return original.name_full, original.type, is_instance and thing.data.name


class Shapes:
    def __init__(self, folder, materials, messages):
        self.folder, self.materials, self.messages = folder, materials, messages
        self.top = []  # shapes in world space
        self.parts = {}  # shapes of each identity
        self.places = {}  # where it stands, and by what name
        self.groups = {}
        self.files = 0

    def mesh(self, columns):
        """A shape of triangles."""
        self.files += 1
        return {"type": "mesh", "file": ply.write(os.path.join(self.folder, f"mesh-{self.files}.ply"), columns)}

    def add(self, thing, matrix, is_instance):
        """An object, or one more copy of it."""
        if thing.type in NOTHING_TO_SEE:
            return
        if thing.type not in GEOMETRY:
            self.messages.add(thing.name, f"an object of type {thing.type} is not exported")
            return
        if abs(matrix.determinant()) < 1e-12:
            self.messages.add(thing.name, "an object that is scaled to nothing is not exported")
            return
        self.report_features(thing.original)
        key = identity(thing, is_instance)
        if key not in self.parts:
            self.parts[key] = self.convert(thing)
        self.places.setdefault(key, []).append((matrix, thing.name))

    def report_features(self, thing):
        hidden = [ray for ray in RAYS if not getattr(thing, f"visible_{ray}")]
        if hidden:
            self.messages.add(thing.name, f"it is not hidden from rays ({', '.join(hidden)})")
        if thing.is_holdout or thing.is_shadow_catcher:
            self.messages.add(thing.name, "holdouts and shadow catchers are not exported: it is seen")
        for system in thing.particle_systems:
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                self.messages.add(thing.name, f'hair "{system.name}" is not exported')

    def convert(self, thing):
        """The parts of an object, in its own space."""
        mesh = thing.to_mesh()
        if mesh is None or not mesh.polygons:
            return []
        parts, slots, uv = [], thing.material_slots, ply.uv_map(mesh)
        uv_name = uv.name if uv else None
        for slot, columns in ply.by_material(mesh).items():
            material = slots[min(slot, len(slots) - 1)].material if slots else None
            look = self.materials.look(material, uv_name)
            parts.append(dict(self.mesh(columns), **look))
        thing.to_mesh_clear()
        return parts

    def placed(self):
        """All shapes. Only parts that don't emit can be instances."""
        shapes = list(self.top)
        for key, parts in self.parts.items():
            places = self.places[key]
            if len(places) == 1 or any("emission" in part for part in parts):
                shapes += [dict(part, name=name, transform=rows(m)) for m, name in places for part in parts]
            elif parts:
                group = f"group-{len(self.groups) + 1}"
                self.groups[group] = parts
                shapes += [{"type": "instance", "group": group, "name": name, "transform": rows(m)}
                           for m, name in places]
        return shapes
