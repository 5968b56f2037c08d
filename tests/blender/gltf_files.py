"""glTF files in the manner of Khronos' sample models, made by script."""

import base64
import json
import os
import struct
import zlib

QUAD = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
UVS = [(0, 1), (1, 1), (1, 0), (0, 0)]
CORNERS = [0, 1, 2, 0, 2, 3]
FLOAT, SHORT, BYTE = 5126, 5123, 5121
CODES = {FLOAT: "f", SHORT: "H", BYTE: "B"}
KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


def png(rows):
    """A picture of rows of (r, g, b), 0 to 255."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    raw = b"".join(b"\0" + bytes(value for pixel in row for value in pixel) for row in rows)
    head = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")


def flat(colour, **more):
    """A material that reflects that much and has no gloss."""
    return {"pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": 0, "roughnessFactor": 1},
            "extensions": {"KHR_materials_specular": {"specularFactor": 0}}, **more}


class File:
    """A document with its bytes, and a camera 3 m before the origin that sees 2 m there."""

    def __init__(self):
        self.data = bytearray()
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                     "materials": [], "accessors": [], "bufferViews": [],
                     "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6435, "znear": 0.1,
                                                                        "aspectRatio": 1.3333}}]}
        self.node(camera=0, translation=[0, 0, 3])

    def view(self, data, **more):
        self.data += bytes(-len(self.data) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **more})
        self.data += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values, kind=FLOAT, **more):
        width = len(values[0]) if isinstance(values[0], tuple) else 1
        numbers = [x for value in values for x in (value if width > 1 else [value])]
        entry = {"componentType": kind, "count": len(values), "type": KINDS[width], **more}
        if "bufferView" not in more:
            entry["bufferView"] = self.view(struct.pack(f"<{len(numbers)}{CODES[kind]}", *numbers))
        if width == 3:
            entry["min"], entry["max"] = ([f(v[k] for v in values) for k in range(3)] for f in (min, max))
        self.json["accessors"].append(entry)
        return len(self.json["accessors"]) - 1

    def mesh(self, attributes, indices=None, material=None, **more):
        primitive = {"attributes": attributes, **more}
        if indices is not None:
            primitive["indices"] = indices
        if material is not None:
            self.json["materials"].append(material)
            primitive["material"] = len(self.json["materials"]) - 1
        self.json["meshes"].append({"primitives": [primitive]})
        return len(self.json["meshes"]) - 1

    def quad(self, material=None, uvs=False, **more):
        attributes = {"POSITION": self.accessor(QUAD), "NORMAL": self.accessor([(0, 0, 1)] * 4)}
        if uvs:
            attributes["TEXCOORD_0"] = self.accessor(UVS)
        return self.mesh(attributes, self.accessor(CORNERS, SHORT), material, **more)

    def node(self, parent=None, **keys):
        self.json["nodes"].append(keys)
        index = len(self.json["nodes"]) - 1
        owner = self.json["scenes"][0]["nodes"] if parent is None else self.json["nodes"][parent].setdefault("children", [])
        owner.append(index)
        return index

    def texture(self, rows, **sampler):
        index = len(self.json.setdefault("textures", []))
        self.json.setdefault("images", []).append({"bufferView": self.view(png(rows)), "mimeType": "image/png"})
        self.json.setdefault("samplers", []).append({"magFilter": 9728, "minFilter": 9728, **sampler})
        self.json["textures"].append({"source": index, "sampler": index})
        return index

    def document(self):
        used = sorted(set(self.extensions(self.json)))
        return {**{key: value for key, value in self.json.items() if value}, **({"extensionsUsed": used} if used else {})}

    def extensions(self, part):
        for key, value in part.items() if isinstance(part, dict) else enumerate(part):
            if key == "extensions":
                yield from value
            if isinstance(value, (dict, list)):
                yield from self.extensions(value)

    def write(self, folder, how="glb"):
        """`how`: glb, embedded (one .gltf), or separate (.gltf and .bin). Returns the file's path."""
        document, data = self.document(), bytes(self.data + bytes(-len(self.data) % 4))
        document["buffers"] = [{"byteLength": len(data)}]
        path = os.path.join(folder, "model.glb" if how == "glb" else "model.gltf")
        if how == "embedded":
            document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        elif how == "separate":
            document["buffers"][0]["uri"] = "model.bin"
            with open(os.path.join(folder, "model.bin"), "wb") as out:
                out.write(data)
        text = json.dumps(document).encode()
        if how == "glb":
            text += b" " * (-len(text) % 4)
            text = b"".join([b"glTF", struct.pack("<2I", 2, 28 + len(text) + len(data)), struct.pack("<I", len(text)),
                             b"JSON", text, struct.pack("<I", len(data)), b"BIN\0", data])
        with open(path, "wb") as out:
            out.write(text)
        return path
