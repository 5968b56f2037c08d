#include "scene/load/gltf/specular_glossiness.h"

#include "scene/load/gltf/textures.h"
#include "scene/textures/function_texture.h"

#include <algorithm>
#include <cmath>

namespace keyhole::gltf {
namespace {

/// Reflectance of plastic along its normal.
constexpr double kPlastic = 0.04;

double largest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }

/// Whether one doesn't see a hue.
bool is_grey(const Rgb& c) { return largest(c) - std::min({c.x, c.y, c.z}) <= 0.1 * largest(c); }

/// Perceived brightness: the weights are those of HSP.
double brightness(const Rgb& c) { return std::sqrt(0.299 * c.x * c.x + 0.587 * c.y * c.y + 0.114 * c.z * c.z); }

/// The share m of metal for which a base colour b gives both colours: diffuse (1 - max(specular)) = b (1 - 0.04) (1 -
/// m), specular = 0.04 (1 - m) + b m. Without b that is a quadratic equation in m.
double metallic_of(const Rgb& diffuse, const Rgb& specular) {
    const double s = brightness(specular);
    if (s < kPlastic || is_grey(specular)) return 0;
    const double b = brightness(diffuse) * (1 - largest(specular)) / (1 - kPlastic) + s - 2 * kPlastic;
    const double root = std::sqrt(std::max(b * b - 4 * kPlastic * (kPlastic - s), 0.0));
    return std::clamp((root - b) / (2 * kPlastic), 0.0, 1.0);
}

Rgb base_of(const Rgb& diffuse, const Rgb& specular) {
    constexpr double kTiny = 1e-6;
    const double m = metallic_of(diffuse, specular);
    if (m == 0) return diffuse;
    const Rgb of_diffuse = diffuse * ((1 - largest(specular)) / (1 - kPlastic) / std::max(1 - m, kTiny));
    const Rgb of_specular = (specular - Rgb(kPlastic * (1 - m))) * (1 / std::max(m, kTiny));
    Rgb base = of_diffuse * (1 - m * m) + of_specular * (m * m);
    for (int c = 0; c < 3; ++c) base[c] = std::clamp(base[c], 0.0, 1.0);
    return base;
}

double reflectance_of(const Rgb& diffuse, const Rgb& specular) {
    constexpr double kMost = 0.97; // of a mirror the index would be infinite
    return metallic_of(diffuse, specular) > 0 ? kPlastic : std::clamp(luminance(specular), 0.0, kMost);
}

} // namespace

MetallicRoughness from_specular_glossiness(Document& document, const Json& extension) {
    constexpr const char* kBoth = "specularGlossinessTexture";
    constexpr int kAlpha = 3;
    const ColorTexture diffuse = color(document, extension, "diffuseFactor", "diffuseTexture", 4),
                       specular = color(document, extension, "specularFactor", kBoth);
    const FloatTexture glossiness = number(document, extension, "glossinessFactor", 1, kBoth, kAlpha);
    return {computed_texture(base_of, diffuse, specular), computed_texture(metallic_of, diffuse, specular),
            computed_texture([](double g) { return std::clamp(1 - g, 0.0, 1.0); }, glossiness),
            computed_texture(reflectance_of, diffuse, specular)};
}

} // namespace keyhole::gltf
