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

/// pbrt's kind of this name is v3's, which is rough where it is rough along its tangent or across it.
MaterialPtr read_glass(Properties& p) {
    constexpr NumberRange kTint{"a tint", 0, 1};
    const Roughness rough = p.roughness({"", "roughness"}, RoughnessScale::pbrt_v3);
    const Key index{"", "index"};
    const double eta = p.refractive_index(p.has(index) ? index : Key("ior", "eta"));
    if (p.has({"", "uroughness"}) || p.has({"", "vroughness"})) return make_dielectric(eta, rough.x, rough.y);
    return make_glass(eta, p.color({"reflect_tint", "Kr"}, ColorUse::reflectance, kTint, Rgb(1.0)),
                      p.color({"transmit_tint", "Kt"}, ColorUse::reflectance, kTint, Rgb(1.0)));
}

MaterialPtr read_dielectric(Properties& p) {
    const Roughness rough = p.roughness("roughness");
    return make_dielectric(p.refractive_index({"ior", "eta"}), rough.x, rough.y);
}

} // namespace

MaterialPtr make_glass(double eta, const Rgb& reflect_tint, const Rgb& transmit_tint) {
    const GlassBsdf glass{checked_index(eta), clamp01(reflect_tint), clamp01(transmit_tint)};
    return make_material("glass", {}, [glass](const SurfacePoint& /*point*/) -> Bsdf::Model { return glass; });
}

MaterialPtr make_dielectric(double eta, FloatTexture alpha_x, FloatTexture alpha_y) {
    checked_index(eta);
    return make_material(
        "dielectric", {.finite = true, .delta = true, .glossy = true},
        [=](const SurfacePoint& point) -> Bsdf::Model {
            const auto rough = rough_at(alpha_x, alpha_y, point);
            if (!rough || std::abs(eta - 1) < kNoRefraction) return GlassBsdf{eta};
            return RoughDielectricBsdf{static_cast<float>(eta), rough->x, rough->y};
        },
        alpha_x, alpha_y);
}

MaterialPtr make_thin_dielectric(double eta) {
    const ThinDielectricBsdf pane{checked_index(eta)};
    return make_material("thin_dielectric", {}, [pane](const SurfacePoint& /*point*/) -> Bsdf::Model { return pane; });
}

MaterialPtr make_interface() {
    return make_material("interface", {}, [](const SurfacePoint& /*point*/) -> Bsdf::Model { return InterfaceBsdf{}; });
}

MaterialKinds dielectric_kinds() {
    return {{"glass", "glass", {"ior", "reflect_tint", "transmit_tint", "bump"}, read_glass},
            {"dielectric", "a dielectric", {"ior", "roughness", "bump"}, read_dielectric},
            {{"thin_dielectric", "thindielectric"},
             "a pane",
             {"ior", "bump"},
             [](Properties& p) {
                 return make_thin_dielectric(p.refractive_index({"ior", "eta"}));
             }},
            {"interface", "an interface", {}, [](Properties&) { return make_interface(); }},
            {{"", "none"}, "", {}, [](Properties&) { return make_interface(); }}};
}

} // namespace keyhole
