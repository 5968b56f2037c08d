#include "scene/load/properties.h"
#include "scene/materials/make_material.h"

namespace keyhole {
namespace {

ColorTexture scaled(ColorTexture value, double factor) {
    return factor == 1 ? value : scale_texture<Rgb>(std::move(value), constant_texture(factor));
}

MaterialPtr read_transmission(Properties& p) {
    const double scale = p.number({"", "scale"}, kNotNegative, 1);
    return make_diffuse_transmission(scaled(p.color_texture("reflectance", 0.25), scale),
                                     scaled(p.color_texture("transmittance", 0.25), scale));
}

/// pbrt-v3's Lambertian surface.
MaterialPtr read_matte(Properties& p) {
    if (p.number({"", "sigma"}, kNotNegative, 0) > 0) p.warn("sigma", "'sigma' is ignored: the surface is Lambertian");
    return make_diffuse(p.color_texture({"", "Kd"}, 0.5));
}

/// pbrt-v3's, without its gloss.
MaterialPtr read_translucent(Properties& p) {
    const ColorTexture kd = p.color_texture({"", "Kd"}, 0.25);
    const auto share = [&](Key key) { return luminance(p.color(key, ColorUse::reflectance, kReflectance, Rgb(0.5))); };
    const double reflect = share({"", "reflect"}), transmit = share({"", "transmit"});
    p.ignore({"Ks", "roughness", "remaproughness"});
    p.warn("v3 translucent", "the material 'translucent' of pbrt-v3 becomes a diffusetransmission");
    return make_diffuse_transmission(scaled(kd, reflect), scaled(kd, transmit));
}

} // namespace

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

MaterialKinds diffuse_kinds() {
    return {{{"black", ""}, "a black material", {"bump", "normal_map"}, [](Properties&) { return make_black(); }},
            {"diffuse",
             "a diffuse material",
             {"reflectance", "bump", "normal_map"},
             [](Properties& p) { return make_diffuse(p.color_texture("reflectance", 0.5)); }},
            {{"diffuse_transmission", "diffusetransmission"},
             "a translucent material",
             {"reflectance", "transmittance", "bump", "normal_map"},
             read_transmission},
            {{"", "matte"}, "", {}, read_matte},
            {{"", "translucent"}, "", {}, read_translucent}};
}

} // namespace keyhole
