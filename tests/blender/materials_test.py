"""Each shader node, and nodes of colours and normals."""

from harness import Nodes, agree, ball, floor, lamp, rgba, test

ORANGE = 0.8, 0.35, 0.1


def scene_with(material, on_floor=False, smooth=False):
    """Smooth surfaces get no lamp: Cycles' lamps are seen in mirrors, ours are not."""
    floor(material if on_floor else None)
    if not on_floor:
        ball(material)
    if not smooth:
        lamp("AREA", size=2, turn=(0.3, 0.3, 0))


def one_node(kind, distribution=None, within=0.03, **inputs):
    nodes = Nodes(kind)
    node = nodes.add(kind, True, **inputs)
    if distribution:
        node.distribution = distribution
    scene_with(nodes.material, smooth=distribution == "SHARP")
    return agree(within)


@test
def diffuse_node():
    return one_node("ShaderNodeBsdfDiffuse", Color=rgba(ORANGE))


@test
def glossy_node():
    return one_node("ShaderNodeBsdfGlossy", Color=rgba(ORANGE), Roughness=0.5)


@test
def glossy_node_smooth():
    return one_node("ShaderNodeBsdfGlossy", "SHARP", Color=rgba((0.9, 0.8, 0.7)))


@test
def glass_node():
    return one_node("ShaderNodeBsdfGlass", "SHARP", Color=rgba((0.9, 1, 0.9)), IOR=1.3)


@test
def glass_node_rough():
    """Cycles takes the Fresnel term of the surface, Keyhole that of each microfacet."""
    return one_node("ShaderNodeBsdfGlass", "GGX", within=0.13, Color=rgba((1, 1, 1)), Roughness=0.3)


@test
def translucent_node():
    return one_node("ShaderNodeBsdfTranslucent", Color=rgba(ORANGE))


@test
def transparent_node():
    return one_node("ShaderNodeBsdfTransparent", Color=rgba((0.5, 0.5, 0.5)))


@test
def emission_node():
    return one_node("ShaderNodeEmission", Color=rgba(ORANGE), Strength=3)


def two_nodes(combine, a, b, **inputs):
    nodes = Nodes("Two")
    both = nodes.add(combine, True, **inputs)
    first = 1 if combine == "ShaderNodeMixShader" else 0
    nodes.add(a[0], both.inputs[first], **a[1])
    nodes.add(b[0], both.inputs[first + 1], **b[1])
    scene_with(nodes.material)
    return agree()


@test
def mix_node():
    return two_nodes("ShaderNodeMixShader", ("ShaderNodeBsdfDiffuse", {"Color": rgba(ORANGE)}),
                     ("ShaderNodeBsdfGlossy", {"Color": rgba((0.2, 0.4, 0.9)), "Roughness": 0.5}), Fac=0.3)


@test
def mix_node_with_transparent():
    return two_nodes("ShaderNodeMixShader", ("ShaderNodeBsdfTransparent", {}),
                     ("ShaderNodeBsdfDiffuse", {"Color": rgba(ORANGE)}), Fac=0.6)


@test
def mix_node_with_emission():
    return two_nodes("ShaderNodeMixShader", ("ShaderNodeEmission", {"Color": rgba(ORANGE)}),
                     ("ShaderNodeBsdfDiffuse", {"Color": rgba((0.1, 0.5, 0.2))}), Fac=0.6)


@test
def add_node():
    return two_nodes("ShaderNodeAddShader", ("ShaderNodeBsdfDiffuse", {"Color": rgba((0.4, 0.3, 0.2))}),
                     ("ShaderNodeBsdfGlossy", {"Color": rgba((0.2, 0.3, 0.4)), "Roughness": 0.6}))


@test
def add_node_with_emission():
    return two_nodes("ShaderNodeAddShader", ("ShaderNodeBsdfDiffuse", {"Color": rgba(ORANGE)}),
                     ("ShaderNodeEmission", {"Color": rgba((0.1, 0.2, 0.4))}))
