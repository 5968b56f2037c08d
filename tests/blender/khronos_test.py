"""glTF files in the manner of Khronos' samples, by `keyhole render`: under a white sky what is flat shows its colour."""

import os
import subprocess
import tempfile

import numpy as np

from gltf_files import BYTE, CORNERS, File, QUAD, SHORT, flat
from harness import test
from keyhole import exr

GREEN = 0.2, 0.6, 0.3
OPTIONS = "--no-png --method path --spp 64 --resolution 32x24".split()


def rendered(path):
    """The picture (height, width, 3), and what is said."""
    output = os.path.join(os.path.dirname(path), "picture.exr")
    done = subprocess.run([os.environ["KEYHOLE"], "render", path, "-o", output, *OPTIONS], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    picture = exr.read(output)
    return np.stack([picture[c] for c in "RGB"], 2), done.stderr


def shows(file, where, colour, how="glb", within=0.03, says=()):
    """`where`: across and down, from 0 to 1. Returns the picture."""
    with tempfile.TemporaryDirectory() as folder:
        picture, text = rendered(file.write(folder, how))
    x, y = int(where[0] * 32), int(where[1] * 24)
    found = picture[y - 1:y + 1, x - 1:x + 1].mean((0, 1))
    assert np.allclose(found, colour, rtol=within, atol=0.005), (found, colour)
    for part in says:
        assert part in text, (part, text)
    return picture


@test
def triangle_without_indices():
    file = File()
    file.node(mesh=file.mesh({"POSITION": file.accessor([(-1, -1, 0), (1, -1, 0), (0, 1, 0)])}, material=flat(GREEN)))
    shows(file, (0.5, 0.5), GREEN, "embedded", says=["found no light"])


@test
def indexed_and_separate():
    for kind in (SHORT, BYTE):
        file = File()
        file.node(mesh=file.mesh({"POSITION": file.accessor(QUAD)}, file.accessor(CORNERS, kind), flat(GREEN)))
        shows(file, (0.5, 0.5), GREEN, "separate")


@test
def simple_meshes():
    """One mesh at two places, below nodes with turns and scales."""
    file = File()
    mesh = file.quad(flat(GREEN))
    owner = file.node(scale=[0.3, 0.3, 0.3])
    file.node(owner, mesh=mesh, translation=[-2, 0, 0])
    file.node(owner, mesh=mesh, translation=[2, 0, 0], rotation=[0, 0, 0.3827, 0.9239])
    picture = shows(file, (0.27, 0.5), GREEN)
    assert np.allclose(picture[12, 23], GREEN, rtol=0.03) and np.allclose(picture[12, 16], 1, rtol=0.01)


@test
def matrix_of_a_node():
    file = File()
    file.node(mesh=file.quad(flat(GREEN)), matrix=[0.2, 0, 0, 0, 0, 0.2, 0, 0, 0, 0, 1, 0, 0.8, 0.5, 0, 1])
    picture = shows(file, (0.8, 0.25), GREEN)
    assert np.allclose(picture[12, 16], 1, rtol=0.01)


@test
def interleaved():
    file = File()
    numbers = b"".join(np.array([*p, 0, 0, 1], "<f4").tobytes() for p in QUAD)
    view = file.view(numbers, byteStride=24)
    position = file.accessor(QUAD, bufferView=view)
    normal = file.accessor([(0, 0, 1)] * 4, bufferView=view, byteOffset=12)
    file.node(mesh=file.mesh({"POSITION": position, "NORMAL": normal}, file.accessor(CORNERS, SHORT), flat(GREEN)))
    shows(file, (0.5, 0.5), GREEN)


@test
def sparse_accessor():
    """All corners at one place but for those that the sparse part moves."""
    file = File()
    indices, values = file.view(np.arange(4, dtype="<u2").tobytes()), file.view(np.array(QUAD, "<f4").tobytes())
    base = file.view(np.zeros(12, "<f4").tobytes())
    position = file.accessor(QUAD, bufferView=base, sparse={
        "count": 4, "indices": {"bufferView": indices, "componentType": SHORT}, "values": {"bufferView": values}})
    file.node(mesh=file.mesh({"POSITION": position}, file.accessor(CORNERS, SHORT), flat(GREEN)))
    shows(file, (0.5, 0.5), GREEN)


@test
def textured_and_transformed():
    """Black on the left, white on the right; turned by its transform black is at the bottom, and repeated it is both."""
    for transform, places in ((None, [(0.3, 0.5, 0), (0.7, 0.5, 1)]),
                              ({"offset": [0.5, 0]}, [(0.3, 0.5, 1), (0.7, 0.5, 0)]),
                              ({"scale": [2, 1]}, [(0.2, 0.5, 0), (0.4, 0.5, 1), (0.6, 0.5, 0)])):
        file = File()
        material = flat((0.8, 0.8, 0.8))
        texture = material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": file.texture([[(0,) * 3, (255,) * 3]])}
        if transform:
            texture["extensions"] = {"KHR_texture_transform": transform}
        file.node(mesh=file.quad(material, uvs=True))
        for x, y, white in places:
            shows(file, (x, y), (0.8 * white,) * 3)


@test
def metal_and_roughness():
    """Under a white sky a metal of little roughness shows its colour, too; green is roughness, blue how metallic."""
    file = File()
    texture = file.texture([[(0, 60, 255)]])
    file.node(mesh=file.quad({"pbrMetallicRoughness": {
        "baseColorFactor": [0.9, 0.6, 0.3, 1], "metallicRoughnessTexture": {"index": texture}}}, uvs=True))
    shows(file, (0.5, 0.5), (0.9, 0.6, 0.3))


@test
def emissive_strength():
    file = File()
    file.node(mesh=file.quad(flat((0, 0, 0), emissiveFactor=[1, 0.5, 0.25], extensions={
        "KHR_materials_emissive_strength": {"emissiveStrength": 4}, "KHR_materials_specular": {"specularFactor": 0}})))
    shows(file, (0.5, 0.5), (4, 2, 1))


@test
def alpha_modes():
    for mode, colour in (("OPAQUE", GREEN), ("BLEND", [0.25 * c + 0.75 for c in GREEN]), ("MASK", (1, 1, 1))):
        file = File()
        material = flat(GREEN, alphaMode=mode)
        material["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.25
        file.node(mesh=file.quad(material))
        shows(file, (0.5, 0.5), colour, within=0.1)


@test
def lights_punctual():
    """A sun of 683 lx from ahead: the quad's radiance is its reflectance over pi."""
    file = File()
    file.json["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 683}]}}
    file.node(extensions={"KHR_lights_punctual": {"light": 0}})
    file.node(mesh=file.quad(flat(GREEN)))
    picture = shows(file, (0.5, 0.5), [c / np.pi for c in GREEN])
    assert picture[0, 0].max() < 0.1, "no sky besides"


@test
def what_is_left_out_is_said():
    file = File()
    mesh = file.quad(flat(GREEN, extensions={"KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]},
                                             "KHR_materials_specular": {"specularFactor": 0}}))
    node = file.node(mesh=mesh)
    times, moves = file.accessor([0.0, 1.0], min=[0], max=[1]), file.accessor([(0, 0, 0), (1, 0, 0)])
    file.json["animations"] = [{"samplers": [{"input": times, "output": moves}],
                                "channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}}]}]
    file.json["cameras"].append({"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}})
    file.node(camera=1)
    shows(file, (0.5, 0.5), GREEN, says=["animations are left out", "KHR_materials_sheen"])
