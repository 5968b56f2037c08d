"""Nodes that give numbers, colours and normals. Each function is one node."""

from .images import encoding, has_holes
from .nodes import source_of, value_node

WRAP = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "black"}


def scaled(value, factor):
    """A number, colour or texture times a number or texture."""
    if factor == 1:
        return value
    if isinstance(value, dict) or isinstance(factor, dict):
        return {"type": "scale", "texture": value, "factor": factor}
    return [x * factor for x in value] if isinstance(value, list) else value * factor


def mixed(a, b, amount):
    """The share `amount` of `b`, the rest of `a`; each a number, and a or b a colour or a texture."""
    if amount == 0 or a == b:
        return a
    if amount == 1:
        return b
    return {"type": "mix", "a": a, "b": b, "amount": amount}


@value_node("RGB", "VALUE")
def constant(_tree, _node, output):
    return list(output.default_value)[:3] if output.type == "RGBA" else output.default_value


@value_node("TEX_IMAGE")
def image(tree, node, output):
    """As in Cycles, colours are multiplied by alpha unless that is used besides."""
    if node.image is None:
        return tree.note(node, "has no picture")
    if node.image.source not in {"FILE", "GENERATED"} or node.projection != "FLAT":
        return tree.note(node, f"a picture of source {node.image.source}, {node.projection}, is not exported")
    try:
        faded = not node.outputs["Alpha"].is_linked and has_holes(node.image)
        alone = output.name == "Alpha"
        file = tree.images.alpha_file(node.image) if alone else tree.images.file(node.image, faded)
    except FileNotFoundError as e:
        return tree.note(node, f"found no file {e}")
    space = encoding(node.image)
    if space is None:
        tree.note(node, f"the colour space {node.image.colorspace_settings.name} is not exported")
    texture = {"type": "image", "file": file, "wrap": WRAP.get(node.extension, "repeat")}
    if alone:
        space = "linear"
    if space and not node.image.is_float:
        texture["encoding"] = space
    if node.interpolation == "Closest":
        texture["filter"] = "nearest"
    return dict(texture, **coordinates(tree, node, "UV"))


@value_node("TEX_CHECKER")
def checker(tree, node, _output):
    """Blender's squares are those of Color2 where the sum of their numbers is even."""
    turn = coordinates(tree, node, "Generated")
    scale = tree.constant(node.inputs["Scale"])
    for key in ("repeat", "shift"):
        turn[key] = [x * scale for x in turn.get(key, [1, 1] if key == "repeat" else [0, 0])]
    a, b = tree.value(node.inputs["Color2"]), tree.value(node.inputs["Color1"])
    if source_of(node.inputs["Vector"]) is None:
        tree.note(node, "is not exported in generated coordinates: it has the object's UV coordinates")
    return dict(turn, type="checkerboard", a=a, b=b)


@value_node("MIX_RGB", "MIX")
def mix(tree, node, _output):
    names = ("Fac", "Color1", "Color2")
    sockets = [node.inputs.get(name) for name in names]
    if node.type == "MIX":  # from Blender 3.4 on; it has the sockets of all data types
        kinds = {"RGBA": (0, 6, 7), "FLOAT": (0, 2, 3)}
        if node.data_type not in kinds:
            return tree.note(node, f"a mix of type {node.data_type} is not exported")
        sockets = [node.inputs[k] for k in kinds[node.data_type]]
    amount, a, b = tree.number(sockets[0]), tree.value(sockets[1]), tree.value(sockets[2])
    blend = node.blend_type
    if blend == "MULTIPLY" and amount == 1 and isinstance(b, float):
        return scaled(a, b)
    if blend == "MULTIPLY" and amount == 1 and isinstance(b, list) and max(b) == min(b):
        return scaled(a, b[0])
    if blend != "MIX":
        return tree.note(node, f"the blend {blend} is not exported")
    return mixed(a, b, amount)


def coordinates(tree, node, default):
    """Keys of the texture's mapping: from UV coordinates, by a Mapping node or as they are."""
    source, turn = source_of(node.inputs["Vector"]), {}
    if source is not None and source.node.type == "MAPPING":
        turn = mapping(tree, source.node)
        source = source_of(source.node.inputs["Vector"])
    name = source.name if source is not None else default
    if source is not None and source.node.type not in {"TEX_COORD", "UVMAP"}:
        tree.note(source.node, f"a node of type {source.node.type} is not exported: coordinates are UV")
    elif name not in {"UV"} and source is not None:
        tree.note(source.node, f"coordinates of type {name} are not exported: they are UV")
    if source is not None and source.node.type == "UVMAP" and source.node.uv_map not in {"", tree.uv_map}:
        tree.note(source.node, f'the UV map "{source.node.uv_map}" is not exported: it is "{tree.uv_map}"')
    if tree.uv_map is None:
        tree.note(node, "an object without UV coordinates has one colour of the texture")
    return turn


def mapping(tree, node):
    """Scales, turns about z, then moves, as Keyhole does; with the type Texture the other way round."""
    place, angles, scale = (list(node.inputs[name].default_value) for name in ("Location", "Rotation", "Scale"))
    if any(node.inputs[name].is_linked for name in ("Location", "Rotation", "Scale")) or any(angles[:2]):
        tree.note(node, "only constants and rotations about z are exported")
    if node.vector_type == "TEXTURE":
        if angles[2]:
            tree.note(node, "a rotation of the type Texture is not exported")
        scale = [1 / x if x else 1 for x in scale]
        place, angles = [-x * s for x, s in zip(place, scale)], [0, 0, 0]
    elif node.vector_type != "POINT":
        place = [0, 0, 0]
    degrees = angles[2] * 57.29577951308232
    return {"repeat": scale[:2], "rotate": degrees, "shift": place[:2]}


def relief(tree, socket):
    """Keys of a material for what is linked to a Normal socket."""
    source = source_of(socket)
    if source is None:
        return {}
    if source.node.type == "NORMAL_MAP":
        return normal_map(tree, source.node)
    if source.node.type == "BUMP":
        return bump(tree, source.node)
    tree.note(source.node, f"a node of type {source.node.type} is not exported: the normal is the surface's")
    return {}


def normal_map(tree, node):
    if node.space != "TANGENT" or tree.constant(node.inputs["Strength"]) != 1:
        tree.note(node, "is exported in tangent space, with the strength 1")
    found = tree.value(node.inputs["Color"])
    return {"normal_map": found} if isinstance(found, dict) else {}


def bump(tree, node):
    """Height in metres: the strength, which mixes normals in Blender, scales it, the same where slopes are small."""
    found = tree.number(node.inputs["Height"])
    strength, distance = tree.constant(node.inputs["Strength"]), tree.constant(node.inputs["Distance"])
    keys = relief(tree, node.inputs["Normal"])
    if isinstance(found, dict):
        keys["bump"] = scaled(found, strength * distance * (-1 if node.invert else 1))
    return keys
