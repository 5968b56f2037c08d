#include "scene/materials/make_material.h"

namespace keyhole {
namespace {

constexpr BsdfTraits kSmoothOrRough{.finite = true, .delta = true};

Bsdf::Model conductor(const ComplexIndex& index, const std::optional<Alpha>& rough) {
    if (!rough) return ConductorBsdf{index};
    return RoughConductorBsdf{index, rough->x, rough->y};
}

} // namespace

MaterialPtr make_mirror(const Rgb& reflectance) {
    const MirrorBsdf mirror{clamp01(reflectance)};
    return make_material("mirror", {}, [mirror](const SurfacePoint& /*point*/) -> Bsdf::Model { return mirror; });
}

MaterialPtr make_conductor(const Rgb& eta, const Rgb& k, FloatTexture alpha_x, FloatTexture alpha_y) {
    const ComplexIndex index{eta, k};
    return make_material(
        "conductor", kSmoothOrRough,
        [=](const SurfacePoint& point) { return conductor(index, rough_at(alpha_x, alpha_y, point)); }, alpha_x,
        alpha_y);
}

MaterialPtr make_conductor(ColorTexture reflectance, FloatTexture alpha_x, FloatTexture alpha_y) {
    return make_material(
        "conductor", kSmoothOrRough,
        [=](const SurfacePoint& point) {
            return conductor(index_of_reflectance(reflectance->value(point)), rough_at(alpha_x, alpha_y, point));
        },
        reflectance, alpha_x, alpha_y);
}

} // namespace keyhole
