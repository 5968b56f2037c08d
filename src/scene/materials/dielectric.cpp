#include "core/error.h"
#include "scene/load/properties.h"
#include "scene/materials/make_material.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

double checked_index(double eta) {
    if (!(eta > 0) || !std::isfinite(eta))
        throw InputError(fmt::format("found the refractive index {}, expected a number above 0", eta));
    return eta;
}

/// Closer to 1, directions of light differ by too little to tell the microfacet that refracted it; and refract too
/// little to tell at all.
constexpr double kNoRefraction = 2e-3;

constexpr NumberRange kTint{"a tint", 0, 1};

/// pbrt's kind of this name is v3's, which is rough where it is rough along its tangent or across it.
MaterialPtr read_glass(Properties& p) {
    const Roughness rough = p.roughness({"", "roughness"}, RoughnessScale::pbrt_v3);
    const Key index{"", "index"};
    const double eta = p.refractive_index(p.has(index) ? index : Key("ior", "eta"));
    const Rgb reflect = p.color({"reflect_tint", "Kr"}, ColorUse::reflectance, kTint, Rgb(1.0)),
              transmit = p.color({"transmit_tint", "Kt"}, ColorUse::reflectance, kTint, Rgb(1.0));
    if (p.has({"", "uroughness"}) || p.has({"", "vroughness"}))
        return make_dielectric(eta, rough.x, rough.y, constant_texture(reflect), constant_texture(transmit));
    return make_glass(eta, reflect, transmit);
}

MaterialPtr read_dielectric(Properties& p) {
    const Roughness rough = p.roughness("roughness");
    const ColorTexture reflect = p.color_texture({"reflect_tint", ""}, 1, kTint),
                       transmit = p.color_texture({"transmit_tint", ""}, 1, kTint);
    return make_dielectric(p.refractive_index({"ior", "eta"}), rough.x, rough.y, reflect, transmit);
}

} // namespace

MaterialPtr make_glass(double eta, const Rgb& reflect_tint, const Rgb& transmit_tint) {
    const GlassBsdf glass{checked_index(eta), clamp01(reflect_tint), clamp01(transmit_tint)};
    return make_material("glass", {}, [glass](const SurfacePoint& /*point*/) -> Bsdf::Model { return glass; });
}

MaterialPtr make_dielectric(double eta, FloatTexture alpha_x, FloatTexture alpha_y) {
    const ColorTexture white = constant_texture(Rgb(1.0));
    return make_dielectric(eta, std::move(alpha_x), std::move(alpha_y), white, white);
}

MaterialPtr make_dielectric(double eta, FloatTexture alpha_x, FloatTexture alpha_y, ColorTexture reflect_tint,
                            ColorTexture transmit_tint) {
    checked_index(eta);
    return make_material(
        "dielectric", {.finite = true, .delta = true, .glossy = true, .through = true, .clear = ClearGlass::face},
        [=](const SurfacePoint& point) -> Bsdf::Model {
            const auto rough = rough_at(alpha_x, alpha_y, point);
            const Rgb reflect = clamp01(reflect_tint->value(point)), transmit = clamp01(transmit_tint->value(point));
            if (!rough || std::abs(eta - 1) < kNoRefraction) return GlassBsdf{eta, reflect, transmit};
            return RoughDielectricBsdf{static_cast<float>(eta), rough->x, rough->y, reflect, transmit};
        },
        alpha_x, alpha_y, reflect_tint, transmit_tint);
}

MaterialPtr make_thin_dielectric(double eta) { return make_thin_dielectric(eta, constant_texture(Rgb(1.0))); }

MaterialPtr make_thin_dielectric(double eta, ColorTexture transmit_tint) {
    checked_index(eta);
    return make_material(
        "thin_dielectric", ThinDielectricBsdf::traits(),
        [=](const SurfacePoint& point) -> Bsdf::Model {
            return ThinDielectricBsdf{eta, clamp01(transmit_tint->value(point))};
        },
        transmit_tint);
}

MaterialPtr make_interface() {
    return make_material("interface", {}, [](const SurfacePoint& /*point*/) -> Bsdf::Model { return InterfaceBsdf{}; });
}

MaterialKinds dielectric_kinds() {
    return {{"glass", "glass", {"ior", "reflect_tint", "transmit_tint", "bump", "normal_map"}, read_glass},
            {"dielectric",
             "a dielectric",
             {"ior", "roughness", "reflect_tint", "transmit_tint", "bump", "normal_map"},
             read_dielectric},
            {{"thin_dielectric", "thindielectric"},
             "a pane",
             {"ior", "transmit_tint", "bump", "normal_map"},
             [](Properties& p) {
                 const ColorTexture tint = p.color_texture({"transmit_tint", ""}, 1, kTint);
                 return make_thin_dielectric(p.refractive_index({"ior", "eta"}), tint);
             }},
            {"interface", "an interface", {}, [](Properties&) { return make_interface(); }},
            {{"", "none"}, "", {}, [](Properties&) { return make_interface(); }}};
}

} // namespace keyhole
