// pbrt's surfaces of what scatters light beneath them. We let light out where it came in: a coat over a diffuse base.
#include "scene/bsdfs/coat.h"
#include "scene/load/input.h"
#include "scene/load/properties.h"
#include "scene/materials/make_material.h"
#include "scene/materials/measured_media.h"
#include "scene/textures/function_texture.h"

#include <fmt/format.h>

#include <cmath>

namespace keyhole {
namespace {

/// What a deep medium without a surface sends back of diffuse light (van de Hulst 1980, "Multiple Light Scattering",
/// 15.4: within 0.01). By the similarity relation the anisotropy g counts as less scattering.
Rgb albedo_of_medium(const Rgb& absorption, const Rgb& reduced_scattering) {
    Rgb albedo;
    for (int c = 0; c < 3; ++c) {
        const double a = std::max(0.0, absorption[c]), extinction = a + std::max(0.0, reduced_scattering[c]);
        const double s = extinction > 0 ? std::sqrt(a / extinction) : 1;
        albedo[c] = (1 - s) * (1 - 0.139 * s) / (1 + 1.17 * s);
    }
    return albedo;
}

/// Kept until the coat has it as well: its tables take as long to make as reading thousands of shapes.
std::shared_ptr<const CoatInterface> read_interface(Properties& p) {
    const Key eta{"", "eta"};
    return CoatInterface::of(p.has(eta) ? p.refractive_index(eta) : 1.33);
}

/// The base under a coat that lets out this share of the light that got in: R = rho (1 - F) / (1 - rho F), with F what
/// the coat reflects back down.
ColorTexture base_of_reflectance(ColorTexture reflectance, const CoatInterface& interface) {
    const double back = interface.internal_reflectance(0, 0);
    return computed_texture(
        [back](const Rgb& color) {
            const Rgb r = clamp01(color);
            Rgb base;
            for (int c = 0; c < 3; ++c) base[c] = r[c] > 0 ? r[c] / (1 - back + r[c] * back) : 0;
            return base;
        },
        std::move(reflectance));
}

/// The base of a medium by its name, or by its coefficients, or by its reflectance; pbrt's is milk.
ColorTexture read_base(Properties& p, const CoatInterface& interface) {
    const Key name{"", "name"}, sigma_a{"", "sigma_a"}, sigma_s{"", "sigma_s"};
    const double g = p.number({"", "g"}, {"an anisotropy", -1, 1}, 0);
    ColorTexture absorption = p.find_unbounded_texture(sigma_a), scattering = p.find_unbounded_texture(sigma_s);
    const ColorTexture reflectance = p.find_color_texture({"", "reflectance"}, kReflectance);
    if (const std::string preset = p.word(name); !preset.empty()) {
        const auto found = measured_media().find(preset);
        if (found == measured_media().end()) p.fail(unknown_name("medium", preset, measured_media()));
        const MeasuredMedium& medium = found->second;
        return constant_texture(albedo_of_medium(medium.absorption, medium.reduced_scattering));
    }
    if ((absorption == nullptr) != (scattering == nullptr))
        p.fail(fmt::format("found '{}' alone, expected 'sigma_a' and 'sigma_s'", absorption ? "sigma_a" : "sigma_s"));
    if (!absorption && reflectance) return base_of_reflectance(reflectance, interface);
    if (!absorption) {
        const MeasuredMedium& milk = measured_media().at("Wholemilk");
        absorption = constant_texture(milk.absorption);
        scattering = constant_texture(milk.reduced_scattering);
    }
    return computed_texture([g](const Rgb& a, const Rgb& s) { return albedo_of_medium(a, s * (1 - g)); }, absorption,
                            scattering);
}

/// The coat of what pbrt's files call `kind`.
MaterialPtr coat_over(Properties& p, const char* kind, const ColorTexture& base, double eta) {
    const Roughness rough = p.roughness({"", "roughness"});
    // Lengths scale what is not seen here, and v3's factors the interface's light.
    p.ignore({"scale", "mfp", "Kr", "Kt", "g"});
    p.warn(kind, fmt::format("the material '{}' becomes a coateddiffuse of the medium's reflectance: light comes out "
                             "where it goes in",
                             kind));
    return make_coated_diffuse(base, rough.x, rough.y, eta, constant_texture(0.0));
}

MaterialPtr read_subsurface(Properties& p) {
    const auto interface = read_interface(p);
    return coat_over(p, "subsurface", read_base(p, *interface), interface->eta());
}

/// pbrt-v3's.
MaterialPtr read_kd_subsurface(Properties& p) {
    const auto interface = read_interface(p);
    const ColorTexture base = base_of_reflectance(p.color_texture({"", "Kd"}, 0.5), *interface);
    return coat_over(p, "kdsubsurface", base, interface->eta());
}

} // namespace

MaterialKinds subsurface_kinds() {
    return {{{"", "subsurface"}, "", {}, read_subsurface}, {{"", "kdsubsurface"}, "", {}, read_kd_subsurface}};
}

} // namespace keyhole
