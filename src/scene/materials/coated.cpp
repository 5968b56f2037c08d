#include "scene/materials/make_material.h"

namespace keyhole {
namespace {

constexpr BsdfTraits kSmoothOrRough{.finite = true, .delta = true};

using Roughness = CoatedConductorBsdf::Roughness;

Roughness roughness(const std::optional<Alpha>& rough) {
    return rough ? Roughness{rough->x, rough->y} : Roughness{0, 0};
}

double thickness_at(const FloatTexture& thickness, const SurfacePoint& point) {
    return std::max(0.0, thickness->value(point));
}

} // namespace

MaterialPtr make_coated_diffuse(ColorTexture reflectance, FloatTexture alpha_x, FloatTexture alpha_y, double eta,
                                FloatTexture thickness) {
    return make_material(
        "coated_diffuse", kSmoothOrRough,
        [=, interface = CoatInterface::of(eta)](const SurfacePoint& point) -> Bsdf::Model {
            const Roughness coat = roughness(rough_at(alpha_x, alpha_y, point));
            return CoatedDiffuseBsdf(*interface, clamp01(reflectance->value(point)), coat.x, coat.y,
                                     thickness_at(thickness, point));
        },
        reflectance, alpha_x, alpha_y, thickness);
}

MaterialPtr make_coated_conductor(const Coat& coat, const Rgb& eta, const Rgb& k, FloatTexture alpha_x,
                                  FloatTexture alpha_y) {
    const ComplexIndex metal{eta, k};
    return make_material(
        "coated_conductor", kSmoothOrRough,
        [=, interface = CoatInterface::of(coat.eta)](const SurfacePoint& point) -> Bsdf::Model {
            return CoatedConductorBsdf(*interface, roughness(rough_at(coat.alpha_x, coat.alpha_y, point)),
                                       thickness_at(coat.thickness, point), metal,
                                       roughness(rough_at(alpha_x, alpha_y, point)));
        },
        coat.alpha_x, coat.alpha_y, coat.thickness, alpha_x, alpha_y);
}

MaterialPtr make_coated_conductor(const Coat& coat, ColorTexture reflectance, FloatTexture alpha_x,
                                  FloatTexture alpha_y) {
    return make_material(
        "coated_conductor", kSmoothOrRough,
        [=, interface = CoatInterface::of(coat.eta)](const SurfacePoint& point) -> Bsdf::Model {
            return CoatedConductorBsdf(
                *interface, roughness(rough_at(coat.alpha_x, coat.alpha_y, point)), thickness_at(coat.thickness, point),
                index_of_reflectance(reflectance->value(point)), roughness(rough_at(alpha_x, alpha_y, point)));
        },
        coat.alpha_x, coat.alpha_y, coat.thickness, reflectance, alpha_x, alpha_y);
}

} // namespace keyhole
