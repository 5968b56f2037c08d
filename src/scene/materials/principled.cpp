#include "scene/load/properties.h"
#include "scene/materials/make_material.h"
#include "scene/textures/function_texture.h"

#include <cmath>

namespace keyhole {
namespace {

/// How glass looks that has the given colour once light went in and out (Burley 2015, "Extending the Disney BRDF to a
/// BSDF with Integrated Subsurface Scattering").
Rgb tint_of_glass(const Rgb& color) {
    const Rgb c = clamp01(color);
    return {std::sqrt(c.x), std::sqrt(c.y), std::sqrt(c.z)};
}

/// What all surfaces have of it but glass.
Bsdf::Model opaque_model(const PrincipledTextures& t, const SurfacePoint& point) {
    PrincipledParameters p;
    p.base_color = clamp01(t.base_color->value(point));
    p.metallic = clamp01(t.metallic->value(point));
    const auto rough = rough_at(t.alpha_x, t.alpha_y, point);
    p.alpha_x = rough ? rough->x : 0;
    p.alpha_y = rough ? rough->y : 0;
    p.specular = clamp01(t.specular->value(point));
    p.specular_tint = clamp01(t.specular_tint->value(point));
    p.coat = clamp01(t.clearcoat->value(point) / 4);
    const auto rough_coat = rough_at(t.clearcoat_alpha, t.clearcoat_alpha, point);
    p.coat_alpha = rough_coat ? rough_coat->x : 0;
    p.sheen = clamp01(t.sheen->value(point));
    p.sheen_tint = clamp01(t.sheen_tint->value(point));
    // The cheapest of models where it is enough.
    if (p.metallic == 0 && p.specular == 0 && p.coat == 0 && p.sheen == 0) return DiffuseBsdf{p.base_color};
    return PrincipledBsdf(p);
}

MaterialPtr make_opaque(const PrincipledTextures& t) {
    constexpr BsdfTraits kAny{.finite = true, .delta = true, .diffuse = true, .glossy = true, .through = true};
    return make_material(
        "principled", kAny, [t](const SurfacePoint& point) { return opaque_model(t, point); }, t.base_color, t.metallic,
        t.alpha_x, t.alpha_y, t.specular, t.specular_tint, t.clearcoat, t.clearcoat_alpha, t.sheen, t.sheen_tint);
}

/// The GGX alpha of a roughness and an anisotropy (Burley 2012, 5.4): alpha = roughness^2, stretched along the tangent
/// to an aspect of at most 10.
FloatTexture alpha_of(const FloatTexture& roughness, const FloatTexture& anisotropy, bool along) {
    return computed_texture(
        [along](double roughness, double anisotropy) {
            const double r = clamp01(roughness), aspect = std::sqrt(1 - 0.9 * clamp01(anisotropy));
            return std::min(1.0, along ? r * r / aspect : r * r * aspect);
        },
        roughness, anisotropy);
}

/// The reflectance along the normal of an interface.
double normal_reflectance(double eta) {
    const double r = (eta - 1) / (eta + 1);
    return r * r;
}

/// What `specular` stands for: 8 % at most, 4 % at 0.5 (Burley 2012, 5.4). Without it the index says it.
FloatTexture read_specular(Properties& p, double eta) {
    const FloatTexture specular = p.find_number_texture({"specular", ""}, kShare);
    if (specular == nullptr) return constant_texture(normal_reflectance(eta));
    return scale_texture<double>(specular, constant_texture(0.08));
}

/// Textures that a file says nothing of.
PrincipledTextures plain_textures(double eta) {
    const FloatTexture none = constant_texture(0.0);
    PrincipledTextures t;
    t.metallic = t.specular_tint = t.transmission = t.clearcoat = t.clearcoat_alpha = t.sheen = t.sheen_tint = none;
    t.specular = constant_texture(normal_reflectance(eta));
    t.eta = eta;
    return t;
}

void read_roughness(Properties& p, PrincipledTextures& t, const FloatTexture& anisotropy) {
    const FloatTexture roughness = p.number_texture("roughness", {"a roughness", 0, 1}, 0.5);
    t.alpha_x = alpha_of(roughness, anisotropy, true);
    t.alpha_y = alpha_of(roughness, anisotropy, false);
}

/// pbrt's is v3's "disney", whose gloss of the clearcoat is given the other way round.
FloatTexture read_clearcoat_alpha(Properties& p) {
    if (p.is_pbrt())
        return mix_texture<double>(constant_texture(0.1), constant_texture(0.001),
                                   p.number_texture({"", "clearcoatgloss"}, kShare, 1));
    const FloatTexture roughness = p.number_texture({"clearcoat_roughness", ""}, {"a roughness", 0, 1}, 0.03);
    return alpha_of(roughness, constant_texture(0.0), true);
}

MaterialPtr read_principled(Properties& p) {
    constexpr NumberRange kCoat{"an amount of clearcoat", 0, 4};
    PrincipledTextures t = plain_textures(p.refractive_index({"ior", "eta"}));
    t.base_color = p.color_texture({"base_color", "color"}, p.is_pbrt() ? 0.5 : 0.8);
    t.metallic = p.number_texture("metallic", kShare, 0);
    read_roughness(p, t, p.number_texture({"anisotropy", "anisotropic"}, kShare, 0));
    t.specular = read_specular(p, t.eta);
    t.specular_tint = p.number_texture({"specular_tint", "speculartint"}, kShare, 0);
    t.transmission = p.number_texture({"transmission", "spectrans"}, kShare, 0);
    t.clearcoat = p.number_texture("clearcoat", kCoat, 0);
    t.clearcoat_alpha = read_clearcoat_alpha(p);
    t.sheen = p.number_texture("sheen", kShare, 0);
    t.sheen_tint = p.number_texture({"sheen_tint", "sheentint"}, kShare, 0.5);
    if (p.is_pbrt() && (p.boolean({"", "thin"}, false) || p.has({"", "scatterdistance"})))
        p.warn("v3 disney", "the material 'disney' of pbrt-v3 is neither thin nor translucent here");
    p.ignore({"scatterdistance", "flatness", "difftrans"});
    const SurfaceDefaults surface{p.find_number_texture({"alpha", ""}, {"an opacity", 0, 1}),
                                  p.color({"emission", ""}, ColorUse::light, kLight, Rgb(0.0))};
    const MaterialPtr material = make_principled(t);
    return surface.alpha == nullptr && is_black(surface.emission) ? material : with_surface(material, surface);
}

MaterialPtr read_plastic(Properties& p) {
    PrincipledTextures t = plain_textures(p.refractive_index({"ior", ""}));
    t.base_color = p.color_texture({"base_color", ""}, 0.8);
    read_roughness(p, t, constant_texture(0.0));
    return make_principled(t);
}

} // namespace

FloatTexture principled_alpha(const FloatTexture& roughness) {
    return alpha_of(roughness, constant_texture(0.0), true);
}

PrincipledTextures principled_textures(double eta, const FloatTexture& roughness) {
    PrincipledTextures t = plain_textures(eta);
    t.base_color = constant_texture(Rgb(1.0));
    t.alpha_x = t.alpha_y = principled_alpha(roughness);
    return t;
}

MaterialPtr make_principled(const PrincipledTextures& t) {
    const FloatTexture one = constant_texture(1.0), none = constant_texture(0.0);
    // Metal is never glass.
    const FloatTexture glass = scale_texture<double>(mix_texture<double>(one, none, t.metallic), t.transmission);
    const bool constant = t.metallic->is_constant() && t.transmission->is_constant();
    const double share = constant ? glass->value({}) : 0.5;
    if (share <= 0) return make_opaque(t);
    const ColorTexture tint = computed_texture(tint_of_glass, t.base_color);
    const MaterialPtr clear = make_dielectric(t.eta, t.alpha_x, t.alpha_y, constant_texture(Rgb(1.0)), tint);
    return share >= 1 ? clear : make_mix(make_opaque(t), clear, glass);
}

MaterialKinds principled_kinds() {
    return {{{"principled", "disney"},
             "a principled material",
             {"base_color", "metallic", "roughness", "anisotropy", "specular", "specular_tint", "transmission", "ior",
              "clearcoat", "clearcoat_roughness", "sheen", "sheen_tint", "emission", "alpha", "bump", "normal_map"},
             read_principled},
            {{"plastic", ""}, "plastic", {"base_color", "roughness", "ior", "bump", "normal_map"}, read_plastic}};
}

} // namespace keyhole
