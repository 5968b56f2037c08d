// pbrt's materials of which we have no model. What lies nearest to hair is a principled surface of its colour; to
// measured reflection, in files that we don't read, a grey of some gloss.
#include "scene/load/properties.h"
#include "scene/materials/make_material.h"
#include "scene/textures/function_texture.h"

#include <fmt/format.h>

#include <cmath>

namespace keyhole {
namespace {

/// Absorption [per radius of the hair] of hair with such concentrations of the two melanins (d'Eon et al. 2011, "An
/// Energy-Conserving Hair Reflectance Model").
Rgb absorption_of_melanin(double eumelanin, double pheomelanin) {
    return Rgb(0.419, 0.697, 1.37) * std::max(0.0, eumelanin) + Rgb(0.187, 0.4, 1.05) * std::max(0.0, pheomelanin);
}

/// What light that many hairs scatter has of a colour, from their absorption and their azimuthal roughness (Chiang et
/// al. 2016, "A Practical and Controllable Hair and Fur Model for Production Path Tracing", eq. 9, solved for the
/// colour).
Rgb color_of_absorption(const Rgb& absorption, double beta_n) {
    const double b = clamp01(beta_n);
    const double steepness = 5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))));
    Rgb color;
    for (int c = 0; c < 3; ++c) color[c] = std::exp(-steepness * std::sqrt(std::max(0.0, absorption[c])));
    return color;
}

/// The albedo of opaque, diffuse hairs that look so as a whole, as light is lost from hair to hair: what a half-space
/// reflects (van de Hulst 1980, "Multiple Light Scattering", 15.4) solved for the albedo, with the anisotropy g of
/// convex diffuse bodies, -4/9. Of 0.7, 0.3 and 0.05, tubes at random show 0.61, 0.28 and 0.06, and tubes side by side,
/// seen from across, 0.70, 0.39 and 0.09.
Rgb albedo_of_hair(const Rgb& color) {
    constexpr double g = -4.0 / 9;
    Rgb albedo;
    for (int c = 0; c < 3; ++c) {
        const double r = clamp01(color[c]), b = 1.139 + 1.17 * r;
        const double s =
            (b - std::sqrt(b * b - 4 * 0.139 * (1 - r))) / (2 * 0.139); // (1 - s)(1 - 0.139 s) / (1 + 1.17 s)
        albedo[c] = clamp01((1 - s * s) / (1 - g * s * s));
    }
    return albedo;
}

/// GGX alpha of a longitudinal roughness, whose lobe has the variance of Chiang et al. 2016, eq. 7. A normal that tilts
/// turns what it reflects by twice as much, and the slope of GGX normals varies by alpha over root 2.
double alpha_of_hair(double beta_m) {
    const double b = clamp01(beta_m);
    return (0.726 * b + 0.812 * b * b + 3.7 * std::pow(b, 20)) / std::sqrt(2.0);
}

/// The first of: absorption, colour, melanin. Without any, pbrt's brown hair.
ColorTexture read_hair_color(Properties& p) {
    const FloatTexture beta_n = p.number_texture({"", "beta_n"}, kShare, 0.3);
    FloatTexture eumelanin = p.find_number_texture({"", "eumelanin"}, kNotNegative);
    FloatTexture pheomelanin = p.find_number_texture({"", "pheomelanin"}, kNotNegative);
    ColorTexture reflectance = p.find_color_texture({"", "reflectance"}, kReflectance);
    if (ColorTexture color = p.find_color_texture({"", "color"}, kReflectance); !reflectance) reflectance = color;
    ColorTexture absorption = p.find_unbounded_texture({"", "sigma_a"});
    if (!absorption && reflectance) return reflectance;
    if (!absorption) {
        if (!eumelanin) eumelanin = constant_texture(pheomelanin ? 0.0 : 1.3);
        if (!pheomelanin) pheomelanin = constant_texture(0.0);
        absorption = computed_texture(absorption_of_melanin, eumelanin, pheomelanin);
    }
    return computed_texture(color_of_absorption, absorption, beta_n);
}

MaterialPtr read_hair(Properties& p) {
    const Key eta{"", "eta"};
    PrincipledTextures t = principled_textures(p.has(eta) ? p.refractive_index(eta) : 1.55, constant_texture(0.0));
    t.base_color = computed_texture(albedo_of_hair, read_hair_color(p));
    t.alpha_x = t.alpha_y = computed_texture(alpha_of_hair, p.number_texture({"", "beta_m"}, kShare, 0.3));
    p.ignore({"alpha"});
    p.warn("hair", "the material 'hair' becomes a principled one of its colour, gloss and index: no light goes through "
                   "it, and its scales lie flat");
    return make_principled(t);
}

/// One that pbrt's files name by `kind`, with its file as `file`.
MaterialPtr read_measured(Properties& p, const char* kind, const char* file) {
    const std::string path = p.word({"", file});
    p.warn(fmt::format("{} {}", kind, path),
           fmt::format("the material '{}' becomes a principled one of reflectance 0.5 and roughness 0.5: the measured "
                       "reflection in '{}' is not read",
                       kind, path));
    PrincipledTextures t = principled_textures(1.5, constant_texture(0.5));
    t.base_color = constant_texture(Rgb(0.5));
    return make_principled(t);
}

} // namespace

MaterialKinds substitute_kinds() {
    return {{{"", "hair"}, "", {}, read_hair},
            {{"", "measured"}, "", {}, [](Properties& p) { return read_measured(p, "measured", "filename"); }},
            {{"", "fourier"}, "", {}, [](Properties& p) { return read_measured(p, "fourier", "bsdffile"); }}};
}

} // namespace keyhole
