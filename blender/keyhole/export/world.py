"""The world: a colour or a picture of all directions."""

from mathutils import Euler, Matrix

from .images import encoding

# From the space of Keyhole's pictures (zenith +y, the middle -z, right of it +x) to Blender's (+z, +x, -y).
TO_BLENDER = Matrix(((0, 0, -1), (-1, 0, 0), (0, 1, 0)))


def rotation(node, messages):
    """Of the picture, by a Mapping node between it and the direction."""
    vector = node.inputs["Vector"]
    if not vector.is_linked:
        return Matrix.Identity(3)
    source = vector.links[0].from_node
    if source.type == "TEX_COORD" and vector.links[0].from_socket.name == "Generated":
        return Matrix.Identity(3)
    if source.type != "MAPPING":
        messages.add(f"World, {source.name}", "is not exported: the picture is not turned")
        return Matrix.Identity(3)
    if max(abs(x) for x in source.inputs["Location"].default_value) > 0 or \
            any(x != 1 for x in source.inputs["Scale"].default_value) or source.vector_type not in {"POINT", "VECTOR"}:
        messages.add(f"World, {source.name}", "only its rotation is exported, as that of a point")
    # The node turns the direction that is looked up; the picture turns the other way.
    return Euler(source.inputs["Rotation"].default_value).to_matrix().transposed()


def picture(node, images, messages):
    """Keys of an environment with an Environment Texture; none where it can't be had."""
    where = f"World, {node.name}"
    if node.image is None or node.projection != "EQUIRECTANGULAR":
        messages.add(where, "is not exported: expected a picture, equirectangular")
        return {}
    if encoding(node.image) is None:
        messages.add(where, f"the colour space {node.image.colorspace_settings.name} is not exported")
    try:
        file = images.file(node.image)
    except FileNotFoundError as e:
        messages.add(where, f"found no file {e}")
        return {}
    turn = (rotation(node, messages) @ TO_BLENDER).to_4x4()
    return {"image": file, "transform": [{"matrix": [x for row in turn for x in row]}]}


def export(world, images, messages):
    """The environment as a list of emitters, of one or none."""
    if world is None:
        return []
    rgb, strength, keys = list(world.color), 1, {}
    if world.use_nodes:
        output = world.node_tree.get_output_node("ALL")
        link = output.inputs["Surface"].links if output else []
        if not link:
            return []
        node = link[0].from_node
        if output.inputs["Volume"].is_linked:
            messages.add("World", "its volume is not exported")
        if node.type != "BACKGROUND":
            messages.add(f"World, {node.name}", "is not exported: expected a Background; the world is black")
            return []
        strength, rgb = node.inputs["Strength"].default_value, list(node.inputs["Color"].default_value)[:3]
        if node.inputs["Strength"].is_linked:
            messages.add(f"World, {node.name}", "only a constant strength is exported")
        if node.inputs["Color"].is_linked:
            source = node.inputs["Color"].links[0].from_node
            if source.type == "TEX_ENVIRONMENT":
                keys, rgb = picture(source, images, messages), [1, 1, 1]
                if not keys:
                    return []
            elif source.type == "RGB":
                rgb = list(source.outputs[0].default_value)[:3]
            else:
                messages.add(f"World, {source.name}", "is not exported: the Background has its own colour")
    radiance = [x * strength for x in rgb]
    return [dict(keys, type="environment", radiance=radiance)] if max(radiance) > 0 else []
