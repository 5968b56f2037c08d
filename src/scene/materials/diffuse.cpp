#include "scene/materials/make_material.h"

namespace keyhole {

MaterialPtr make_black() {
    return make_material("black", {}, [](const SurfacePoint& /*point*/) -> Bsdf::Model { return BlackBsdf{}; });
}

MaterialPtr make_diffuse(const Rgb& reflectance) { return make_diffuse(constant_texture(reflectance)); }

MaterialPtr make_diffuse(ColorTexture reflectance) {
    return make_material(
        "diffuse", DiffuseBsdf::traits(),
        [reflectance](const SurfacePoint& point) -> Bsdf::Model {
            return DiffuseBsdf{clamp01(reflectance->value(point))};
        },
        reflectance);
}

MaterialPtr make_diffuse_transmission(ColorTexture reflectance, ColorTexture transmittance) {
    return make_material(
        "diffuse_transmission", DiffuseTransmissionBsdf::traits(),
        [reflectance, transmittance](const SurfacePoint& point) -> Bsdf::Model {
            const Rgb r = clamp01(reflectance->value(point)), t = clamp01(transmittance->value(point));
            const double most = std::max({1.0, r.x + t.x, r.y + t.y, r.z + t.z});
            return DiffuseTransmissionBsdf{r / most, t / most};
        },
        reflectance, transmittance);
}

} // namespace keyhole
