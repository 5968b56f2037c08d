"""The Principled BSDF: a `principled` material. docs/blender.md has a table of where the two differ."""

from .nodes import plain, shader_node
from .shaders import Surface, emitting
from .values import relief, scaled

# socket in Blender: key of the material. Units are the same.
VARYING = {
    "Base Color": "base_color",
    "Metallic": "metallic",
    "Roughness": "roughness",
    "Anisotropic": "anisotropy",
    "Specular": "specular",
    "Specular Tint": "specular_tint",
    "Transmission": "transmission",
    "Clearcoat": "clearcoat",
    "Clearcoat Roughness": "clearcoat_roughness",
    "Sheen": "sheen",
    "Sheen Tint": "sheen_tint",
}
COLOURS = {"Base Color"}
IGNORED = {"Subsurface": 0, "Anisotropic Rotation": 0, "Transmission Roughness": 0}  # socket: what means nothing
TAKEN_BY_GLOSS = 0.12  # of the base's light, at a specular of 1 and all angles: tests/blender/principled_test.py
UNLINKED = "Clearcoat Normal", "Tangent"


@shader_node("BSDF_PRINCIPLED")
def principled(tree, node):
    sockets = node.inputs
    if "Specular" not in sockets:
        tree.note(node, "the sockets of Blender 4 are not exported: expected Blender 3.4 to 3.6; it is grey")
        return Surface({"type": "diffuse", "reflectance": 0.5})
    material = {"type": "principled", "ior": tree.constant(sockets["IOR"]), **relief(tree, sockets["Normal"])}
    for name, key in VARYING.items():
        material[key] = tree.value(sockets[name]) if name in COLOURS else tree.number(sockets[name])
    tint_of_glass(tree, node, material)
    brighten_base(material)
    for name, nothing in IGNORED.items():
        if sockets[name].is_linked or plain(sockets[name].default_value) != nothing:
            tree.note(node, f'"{name}" is not exported')
    for name in UNLINKED:
        if sockets[name].is_linked:
            tree.note(node, f'"{name}" is not exported')
    surface = Surface(material, alpha=tree.number(sockets["Alpha"]))
    return emitting(surface, tree.value(sockets["Emission"]), tree.constant(sockets["Emission Strength"]))


def tint_of_glass(tree, node, material):
    """Keyhole's glass has the root of its colour at each surface, so that a body has the colour; Blender's the colour."""
    base, transmission = material["base_color"], material["transmission"]
    if transmission == 0 or material["metallic"] == 1 or base == [1, 1, 1]:
        return
    if transmission == 1 and material["metallic"] == 0 and isinstance(base, list):
        material["base_color"] = [x * x for x in base]
    else:
        tree.note(node, "what it transmits is tinted by the root of its colour at each surface")


def brighten_base(material):
    """Cycles adds reflections to the diffuse base, Keyhole takes from it what they take: the base gives that back."""
    known = [material[key] for key in ("specular", "metallic", "transmission")]
    if any(isinstance(value, dict) for value in known):
        return
    specular, metallic, transmission = known
    factor = 1 + TAKEN_BY_GLOSS * specular * (1 - metallic) * (1 - transmission)
    base = scaled(material["base_color"], factor)
    material["base_color"] = [min(x, 1) for x in base] if isinstance(base, list) else base
