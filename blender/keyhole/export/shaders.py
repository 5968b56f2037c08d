"""Shader nodes but for Principled. Each function is one node."""

from dataclasses import dataclass, field, replace

from .nodes import shader_node
from .values import mixed, relief, scaled

MIRROR = 1e4  # refractive index of what reflects nearly all light, at all angles


@dataclass
class Surface:
    """What a shape looks like."""
    material: dict = field(default_factory=lambda: {"type": "black"})
    radiance: list = None  # emitted, [r, g, b]
    texture: dict = None  # a factor on it
    alpha: object = 1  # opacity: a number or a texture

    def is_clear(self):
        return self.alpha == 0 and self.radiance is None

    def is_dark(self):
        """Emits at most."""
        return self.material["type"] == "black"


def squared(roughness):
    """Blender's roughness to the alpha of GGX."""
    return scaled(roughness, roughness)


def is_smooth(roughness):
    return not isinstance(roughness, dict) and roughness ** 2 <= 1e-3


def roughness_of(tree, node):
    if node.distribution == "SHARP":
        return 0.0
    roughness = tree.number(node.inputs["Roughness"])
    if node.distribution not in {"GGX", "MULTI_GGX"} and not is_smooth(roughness):
        tree.note(node, f"the distribution {node.distribution} is not exported: it is GGX")
    return roughness


@shader_node("grey")
def grey(_tree, _node):
    """In place of what is not exported."""
    return Surface({"type": "diffuse", "reflectance": 0.5})


@shader_node("BSDF_DIFFUSE")
def diffuse(tree, node):
    if tree.number(node.inputs["Roughness"]) != 0:
        tree.note(node, '"Roughness" is not exported: it is Lambertian')
    return Surface({"type": "diffuse", "reflectance": tree.value(node.inputs["Color"]),
                    **relief(tree, node.inputs["Normal"])})


@shader_node("BSDF_GLOSSY")
def glossy(tree, node):
    """Reflects the same share at all angles."""
    roughness = roughness_of(tree, node)
    return Surface({"type": "dielectric", "ior": MIRROR, "roughness": squared(roughness),
                    "reflect_tint": tree.value(node.inputs["Color"]), **relief(tree, node.inputs["Normal"])})


@shader_node("BSDF_GLASS")
def glass(tree, node):
    tint = tree.value(node.inputs["Color"])
    return Surface({"type": "dielectric", "ior": tree.constant(node.inputs["IOR"]), "reflect_tint": tint,
                    "transmit_tint": tint, "roughness": squared(roughness_of(tree, node)),
                    **relief(tree, node.inputs["Normal"])})


@shader_node("BSDF_TRANSLUCENT")
def translucent(tree, node):
    return Surface({"type": "diffuse_transmission", "reflectance": 0,
                    "transmittance": tree.value(node.inputs["Color"]), **relief(tree, node.inputs["Normal"])})


@shader_node("BSDF_TRANSPARENT")
def transparent(tree, node):
    """A screen with as many holes as light goes through."""
    colour = tree.value(node.inputs["Color"])
    if isinstance(colour, dict) or max(colour) != min(colour):
        tree.note(node, "the hue of transparency is not exported: it is grey")
    return Surface(alpha=1 - tree.constant(node.inputs["Color"]) if isinstance(colour, list) else 0)


@shader_node("EMISSION")
def emission(tree, node):
    colour, strength = tree.value(node.inputs["Color"]), tree.constant(node.inputs["Strength"])
    return emitting(Surface(), colour, strength)


def emitting(surface, colour, strength):
    """A surface that emits besides."""
    if strength <= 0 or (isinstance(colour, list) and max(colour) <= 0):
        return surface
    if isinstance(colour, dict):
        return replace(surface, radiance=[strength] * 3, texture=colour)
    return replace(surface, radiance=[x * strength for x in colour])


def sum_of_light(tree, node, parts):
    """Radiance and texture of several surfaces, each with a share."""
    lit = [(s, share) for s, share in parts if s.radiance is not None]
    if not lit:
        return {}
    textures = [s.texture for s, _ in lit if s.texture]
    if len(lit) > 1 and textures or any(isinstance(share, dict) for _, share in lit):
        tree.note(node, "a sum of textured lights is not exported: the first is there")
        lit = [(lit[0][0], 1)]
    radiance = [sum(share * s.radiance[k] for s, share in lit) for k in range(3)]
    return {"radiance": radiance, "texture": lit[0][0].texture}


@shader_node("MIX_SHADER")
def mix(tree, node):
    a, b = (tree.surface(node.inputs[k]) or Surface() for k in (1, 2))
    amount = tree.number(node.inputs["Fac"])
    if amount in (0, 1):
        return b if amount else a
    if a.is_clear():
        return replace(b, alpha=scaled(amount, b.alpha))
    rest = mixed(1, 0, amount) if isinstance(amount, dict) else 1 - amount
    if b.is_clear():
        return replace(a, alpha=scaled(rest, a.alpha))
    if a.alpha != b.alpha:
        tree.note(node, "a mix of different transparencies is not exported: it has that of the first")
    light = sum_of_light(tree, node, [(a, rest), (b, amount)])
    if a.is_dark() and b.is_dark():
        return Surface(alpha=a.alpha, **light)
    return Surface({"type": "mix", "a": a.material, "b": b.material, "amount": amount}, alpha=a.alpha, **light)


TINTS = {"diffuse": ["reflectance"], "dielectric": ["reflect_tint", "transmit_tint"],
         "diffuse_transmission": ["reflectance", "transmittance"], "black": []}


def doubled(material):
    """A material that sends back twice as much light; None where that can't be said."""
    tints = TINTS.get(material["type"])
    if tints is None:
        return None
    result = dict(material)
    for key in set(tints) & set(material):
        value = material[key]
        if isinstance(value, dict) or 2 * max(value if isinstance(value, list) else [value]) > 1:
            return None
        result[key] = scaled(value, 2)
    return result


@shader_node("ADD_SHADER")
def add(tree, node):
    """The sum of two is a mix by halves of twice as much of each."""
    a, b = (tree.surface(node.inputs[k]) or Surface() for k in (0, 1))
    light = sum_of_light(tree, node, [(a, 1), (b, 1)])
    if a.is_dark() or b.is_dark():
        other = b if a.is_dark() else a
        if a.alpha != b.alpha:
            tree.note(node, "a sum with transparency is not exported: it is opaque")
        return Surface(other.material, **light)
    twice = doubled(a.material), doubled(b.material)
    if None in twice:
        tree.note(node, "a sum of shaders that may be more than white is not exported: it is half of each")
        twice = a.material, b.material
    return Surface({"type": "mix", "a": twice[0], "b": twice[1], "amount": 0.5}, **light)
