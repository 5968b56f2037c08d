"""The Principled BSDF at many settings, and where the two models differ by design: docs/blender.md has the figures."""

from harness import Nodes, agree, ball, floor, lamp, rgba, test

CLAY = 0.6, 0.35, 0.2
BLACK = 0, 0, 0, 1
LIKE_CYCLES = 0.04


def setting(within=LIKE_CYCLES, lit=True, distribution="GGX", **inputs):
    def run():
        nodes = Nodes("Principled")
        node = nodes.add("ShaderNodeBsdfPrincipled", True, **{"Base_Color": rgba(CLAY), **inputs})
        node.distribution = distribution
        floor()
        ball(nodes.material)
        if lit:
            lamp("AREA", size=2, turn=(0.3, 0.3, 0))
        return agree(within)
    return run


# Cycles makes light where the base is white, and loses what rough metal reflects several times.
SETTINGS = {
    "as_it_is": setting(),
    "without_specular": setting(Specular=0.0),
    "rough": setting(0.05, Roughness=1.0),
    "glossy": setting(Roughness=0.25),
    "metal": setting(0.09, Metallic=1.0, Roughness=0.4),
    "metal_multiple": setting(Metallic=1.0, Roughness=0.4, distribution="MULTI_GGX"),
    "half_metal": setting(Metallic=0.5),
    "specular_tint": setting(0.05, Specular=1.0, Specular_Tint=1.0),
    "clearcoat": setting(Clearcoat=1.0, Clearcoat_Roughness=0.3),
    "sheen": setting(0.045, Sheen=1.0),
    "anisotropic_metal": setting(0.15, Metallic=1.0, Roughness=0.5, Anisotropic=0.8),
    "anisotropic_multiple": setting(Metallic=1.0, Roughness=0.5, Anisotropic=0.8, distribution="MULTI_GGX"),
    "glass": setting(Transmission=1.0, Roughness=0.0, lit=False),
    "white": setting(0.09, Base_Color=(1, 1, 1, 1)),
    "emission": setting(Emission=rgba((0.3, 0.2, 0.5)), Emission_Strength=2.0),
    "alpha": setting(Alpha=0.4),
}


def dark_floor(within=0.02, **inputs):
    """Nothing but gloss, under an even sky."""
    def run():
        nodes = Nodes("Principled")
        node = nodes.add("ShaderNodeBsdfPrincipled", True, **{"Base_Color": BLACK, **inputs})
        node.distribution = "GGX"
        floor(nodes.material)
        return agree(within)
    return run


# Cycles' clearcoat has another distribution, and its metals the Fresnel weight of a dielectric.
SETTINGS |= {
    "black": dark_floor(),
    "black_glossy": dark_floor(Roughness=0.1),
    "black_specular": dark_floor(Specular=1.0),
    "black_clearcoat": dark_floor(0.09, Specular=0.0, Clearcoat=1.0, Clearcoat_Roughness=0.1),
    "dark_metal": dark_floor(0.04, Base_Color=rgba((0.3, 0.3, 0.3)), Metallic=1.0, Roughness=0.2),
}
for name, run in SETTINGS.items():
    run.__name__ = name
    test(run)
