#include "scene/materials/read_metal.h"

namespace keyhole {
namespace {

constexpr BsdfTraits kSmoothOrRough{.finite = true, .delta = true, .glossy = true};

/// Where roughness is the same everywhere it is known whether the coat reflects as a mirror.
BsdfTraits coated_diffuse_traits(const FloatTexture& alpha_x, const FloatTexture& alpha_y) {
    BsdfTraits traits{.finite = true, .delta = true, .diffuse = true, .glossy = true};
    if (alpha_x->is_constant() && alpha_y->is_constant()) {
        traits.glossy = rough_at(alpha_x, alpha_y, {}).has_value();
        traits.delta = !traits.glossy;
    }
    return traits;
}

using Alphas = CoatedConductorBsdf::Roughness;

Alphas roughness(const std::optional<Alpha>& rough) { return rough ? Alphas{rough->x, rough->y} : Alphas{0, 0}; }

double thickness_at(const FloatTexture& thickness, const SurfacePoint& point) {
    return std::max(0.0, thickness->value(point));
}

/// Over a metal whose index at a point is `metal(point)`, which reads `textures`.
template <class Metal, class... Textures>
MaterialPtr coated_conductor(const Coat& coat, const FloatTexture& alpha_x, const FloatTexture& alpha_y, Metal metal,
                             const Textures&... textures) {
    return make_material(
        "coated_conductor", kSmoothOrRough,
        [=, interface = CoatInterface::of(coat.eta)](const SurfacePoint& point) -> Bsdf::Model {
            return CoatedConductorBsdf(*interface, roughness(rough_at(coat.alpha_x, coat.alpha_y, point)),
                                       thickness_at(coat.thickness, point), metal(point),
                                       roughness(rough_at(alpha_x, alpha_y, point)));
        },
        coat.alpha_x, coat.alpha_y, coat.thickness, alpha_x, alpha_y, textures...);
}

/// pbrt's coats have some thickness unless they say otherwise.
FloatTexture read_thickness(Properties& p) {
    // Light that a coat scatters is left out.
    const ColorTexture albedo = p.color_texture({"", "albedo"}, 0);
    if (!albedo->is_constant() || !is_black(albedo->value({})))
        p.warn("coat albedo", "the coat scatters nothing: 'albedo' and 'g' are ignored");
    p.ignore({"g", "maxdepth", "nsamples"});
    return p.number_texture("thickness", {"an optical depth", 0, 1e12}, p.is_pbrt() ? 0.01 : 0);
}

MaterialPtr read_coated_diffuse(Properties& p) {
    const Roughness rough = p.roughness("roughness");
    return make_coated_diffuse(p.color_texture("reflectance", 0.5), rough.x, rough.y,
                               p.refractive_index({"ior", "eta"}), read_thickness(p));
}

MaterialPtr read_coated_conductor(Properties& p) {
    const Roughness rough = p.roughness({"roughness", "conductor.roughness"}),
                    outer = p.roughness({"coat_roughness", "interface.roughness"});
    const Coat coat{p.refractive_index({"ior", "interface.eta"}), outer.x, outer.y, read_thickness(p)};
    return read_metal(p, {"eta", "conductor.eta"}, {"k", "conductor.k"},
                      [&](const auto&... metal) { return make_coated_conductor(coat, metal..., rough.x, rough.y); });
}

/// What comes nearest to pbrt-v3's plastic, substrate and uber: a coat of the same roughness, whose reflection follows
/// from its index instead of Ks.
MaterialPtr read_coated_v3(Properties& p, const std::string& kind, double kd) {
    const Roughness rough = p.roughness({"", "roughness"}, RoughnessScale::pbrt_v3, 0.1);
    p.ignore({"Ks", "Kr", "Kt", "opacity", "index"});
    p.warn("v3 " + kind, fmt::format("the material '{}' of pbrt-v3 becomes a coateddiffuse", kind));
    return make_coated_diffuse(p.color_texture({"", "Kd"}, kd), rough.x, rough.y, p.refractive_index({"", "eta"}),
                               constant_texture(0.0));
}

} // namespace

MaterialPtr make_coated_diffuse(ColorTexture reflectance, FloatTexture alpha_x, FloatTexture alpha_y, double eta,
                                FloatTexture thickness) {
    return make_material(
        "coated_diffuse", coated_diffuse_traits(alpha_x, alpha_y),
        [=, interface = CoatInterface::of(eta)](const SurfacePoint& point) -> Bsdf::Model {
            const Alphas coat = roughness(rough_at(alpha_x, alpha_y, point));
            return CoatedDiffuseBsdf(*interface, clamp01(reflectance->value(point)), coat.x, coat.y,
                                     thickness_at(thickness, point));
        },
        reflectance, alpha_x, alpha_y, thickness);
}

MaterialPtr make_coated_conductor(const Coat& coat, const Rgb& eta, const Rgb& k, FloatTexture alpha_x,
                                  FloatTexture alpha_y) {
    return coated_conductor(coat, alpha_x, alpha_y,
                            [index = ComplexIndex{eta, k}](const SurfacePoint&) { return index; });
}

MaterialPtr make_coated_conductor(const Coat& coat, ColorTexture reflectance, FloatTexture alpha_x,
                                  FloatTexture alpha_y) {
    return coated_conductor(
        coat, alpha_x, alpha_y,
        [reflectance](const SurfacePoint& point) { return index_of_reflectance(reflectance->value(point)); },
        reflectance);
}

MaterialKinds coated_kinds() {
    return {{{"coated_diffuse", "coateddiffuse"},
             "a coated material",
             {"reflectance", "ior", "roughness", "thickness", "bump", "normal_map"},
             read_coated_diffuse},
            {{"coated_conductor", "coatedconductor"},
             "a coated conductor",
             {"reflectance", "eta", "k", "roughness", "ior", "coat_roughness", "thickness", "bump", "normal_map"},
             read_coated_conductor},
            {{"", "plastic"}, "", {}, [](Properties& p) { return read_coated_v3(p, "plastic", 0.25); }},
            {{"", "substrate"}, "", {}, [](Properties& p) { return read_coated_v3(p, "substrate", 0.5); }},
            {{"", "uber"}, "", {}, [](Properties& p) { return read_coated_v3(p, "uber", 0.25); }}};
}

} // namespace keyhole
