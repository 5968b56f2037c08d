#include "scene/materials/read_metal.h"

namespace keyhole {
namespace {

constexpr BsdfTraits kConductorTraits{.finite = true, .delta = true, .glossy = true};

Bsdf::Model conductor(const ComplexIndex& index, const std::optional<Alpha>& rough) {
    if (!rough) return ConductorBsdf{index};
    return RoughConductorBsdf{index, rough->x, rough->y};
}

MaterialPtr read_mirror(Properties& p) {
    // pbrt-v3's 'Kr' is less than 1.
    const Key reflectance{"reflectance", "Kr"};
    return make_mirror(p.color(reflectance, ColorUse::reflectance, kReflectance, Rgb(p.is_pbrt() ? 0.9 : 1.0)));
}

MaterialPtr read_conductor(Properties& p) {
    const Roughness rough = p.roughness("roughness");
    return read_metal(p, "eta", "k", [&](const auto&... metal) { return make_conductor(metal..., rough.x, rough.y); });
}

/// pbrt-v3's conductor.
MaterialPtr read_metal_v3(Properties& p) {
    const Roughness rough = p.roughness({"", "roughness"}, RoughnessScale::pbrt_v3, 0.01);
    return make_conductor(read_index(p, {"", "eta"}, kCopperEta), read_index(p, {"", "k"}, kCopperK), rough.x, rough.y);
}

} // namespace

MaterialPtr make_mirror(const Rgb& reflectance) {
    const MirrorBsdf mirror{clamp01(reflectance)};
    return make_material("mirror", {}, [mirror](const SurfacePoint& /*point*/) -> Bsdf::Model { return mirror; });
}

MaterialPtr make_conductor(const Rgb& eta, const Rgb& k, FloatTexture alpha_x, FloatTexture alpha_y) {
    const ComplexIndex index{eta, k};
    return make_material(
        "conductor", kConductorTraits,
        [=](const SurfacePoint& point) { return conductor(index, rough_at(alpha_x, alpha_y, point)); }, alpha_x,
        alpha_y);
}

MaterialPtr make_conductor(ColorTexture reflectance, FloatTexture alpha_x, FloatTexture alpha_y) {
    return make_material(
        "conductor", kConductorTraits,
        [=](const SurfacePoint& point) {
            return conductor(index_of_reflectance(reflectance->value(point)), rough_at(alpha_x, alpha_y, point));
        },
        reflectance, alpha_x, alpha_y);
}

MaterialKinds conductor_kinds() {
    return {
        {"mirror", "a mirror", {"reflectance", "bump", "normal_map"}, read_mirror},
        {"conductor", "a conductor", {"reflectance", "eta", "k", "roughness", "bump", "normal_map"}, read_conductor},
        {{"", "metal"}, "", {}, read_metal_v3}};
}

} // namespace keyhole
