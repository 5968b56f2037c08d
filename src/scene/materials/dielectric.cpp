#include "core/error.h"
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

} // namespace

MaterialPtr make_glass(double eta, const Rgb& reflect_tint, const Rgb& transmit_tint) {
    const GlassBsdf glass{checked_index(eta), clamp01(reflect_tint), clamp01(transmit_tint)};
    return make_material("glass", {}, [glass](const SurfacePoint& /*point*/) -> Bsdf::Model { return glass; });
}

MaterialPtr make_dielectric(double eta, FloatTexture alpha_x, FloatTexture alpha_y) {
    checked_index(eta);
    return make_material(
        "dielectric", {.finite = true, .delta = true},
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

} // namespace keyhole
