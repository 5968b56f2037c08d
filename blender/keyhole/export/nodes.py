"""Following the links of a node tree. What a node becomes stands in values.py, shaders.py and principled.py."""

LUMINANCE = 0.2126, 0.7152, 0.0722

VALUES = {}  # node type: function(tree, node, output socket) -> number, [r, g, b] or texture of a scene file
SHADERS = {}  # node type: function(tree, node) -> Surface


def value_node(*kinds):
    def keep(function):
        VALUES.update((kind, function) for kind in kinds)
        return function
    return keep


def shader_node(*kinds):
    def keep(function):
        SHADERS.update((kind, function) for kind in kinds)
        return function
    return keep


def plain(value):
    """A socket's own value: a number, or [r, g, b]."""
    return list(value)[:3] if hasattr(value, "__len__") else float(value)


def source_of(socket):
    """The socket that a link comes from, through reroutes; None: nothing is linked."""
    while socket is not None and socket.is_linked:
        link = socket.links[0]
        if link.from_node.type != "REROUTE":
            return link.from_socket
        socket = link.from_node.inputs[0]
    return None


class Tree:
    """The nodes of one material, for meshes with a UV map of that name; None: with none."""

    def __init__(self, name, images, messages, uv_map):
        self.name, self.images, self.messages, self.uv_map = name, images, messages, uv_map

    def note(self, node, text):
        self.messages.add(f"{self.name}, {node.label or node.name}", text)

    def value(self, socket):
        """What a socket has: a number, [r, g, b], or a texture."""
        source = source_of(socket)
        if source is None:
            return plain(socket.default_value)
        convert = None if source.node.mute else VALUES.get(source.node.type)
        found = convert(self, source.node, source) if convert else None
        if found is None:
            if convert is None:
                self.note(source.node, f"a node of type {source.node.type} is not exported")
            self.note(socket.node, f'"{socket.name}" has its own value instead')
            return plain(socket.default_value)
        return found

    def number(self, socket):
        """As value(), with luminance for a colour."""
        value = self.value(socket)
        return sum(w * x for w, x in zip(LUMINANCE, value)) if isinstance(value, list) else value

    def constant(self, socket):
        """A number that doesn't vary; the socket's own where it does."""
        value = self.number(socket)
        if isinstance(value, dict):
            self.note(socket.node, f'"{socket.name}" is not exported as a texture: it is one number')
            return float(plain(socket.default_value))
        return value

    def surface(self, socket):
        """What a shader socket has; None: nothing is linked."""
        source = source_of(socket)
        if source is None:
            return None
        convert = SHADERS.get(source.node.type)
        if convert is None or source.node.mute:
            self.note(source.node, f"a shader of type {source.node.type} is not exported: it is grey")
            convert = SHADERS["grey"]
        return convert(self, source.node)
