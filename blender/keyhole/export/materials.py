"""Materials: what a shape has to say of them."""

from . import principled, shaders, values
from .nodes import Tree
from .shaders import Surface

OWNERS = principled, shaders, values  # of the nodes that Tree finds by their types


class Materials:
    def __init__(self, images, messages):
        self.images, self.messages = images, messages
        self.written = {}  # the section `materials`
        self.looks = {}

    def look(self, material, uv_map):
        """Keys of a shape with that UV map, None for none: `material`, `emission` and `alpha` if it needs them."""
        key = (material.name_full if material else None, uv_map)
        if key not in self.looks:
            self.looks[key] = self.convert(material, uv_map)
        return self.looks[key]

    def convert(self, material, uv_map):
        surface = self.surface(material, uv_map)
        name = material.name if material else "default_surface"
        while name in self.written and self.written[name] != surface.material:
            name += "_"
        self.written[name] = surface.material
        look = {"material": name}
        if surface.radiance is not None:
            look["emission"] = {"radiance": surface.radiance, "two_sided": True}
            if surface.texture:
                look["emission"]["texture"] = surface.texture
        if surface.alpha != 1:
            look["alpha"] = surface.alpha
        return look

    def surface(self, material, uv_map):
        if material is None:
            return Surface({"type": "diffuse", "reflectance": 0.8})
        if not material.use_nodes:
            return Surface({"type": "diffuse", "reflectance": list(material.diffuse_color)[:3]})
        output = material.node_tree.get_output_node("ALL")
        if output is None:
            return Surface()
        tree = Tree(material.name, self.images, self.messages, uv_map)
        for name in ("Volume", "Displacement"):
            if output.inputs[name].is_linked:
                tree.note(output, f'"{name}" is not exported')
        return tree.surface(output.inputs["Surface"]) or Surface()
