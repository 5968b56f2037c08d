#include "film/tonemap.h"

#include "core/vec.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

constexpr double kKey = 0.18;
constexpr double kWhitePercentile = 0.995;

/// Colour of a pixel; black if it is not finite.
Rgb colour(const Image& image, std::size_t pixel) {
    const float* p = image.data.data() + pixel * static_cast<std::size_t>(image.channels);
    const Rgb c = image.channels < 3 ? Rgb(p[0]) : Rgb(p[0], p[1], p[2]);
    return is_finite(c) ? c : Rgb(0.0);
}

/// Scale to the key (equations 1 and 2), and the white point after it.
struct ToneCurve {
    double scale = 1, white = 1;
};

ToneCurve expose(const Image& image) {
    std::vector<double> lit;
    double log_sum = 0;
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const double y = luminance(colour(image, i));
        if (!(y > 0)) continue;
        lit.push_back(y);
        log_sum += std::log(y);
    }
    if (lit.empty()) return {};
    const double scale = kKey / std::exp(log_sum / static_cast<double>(lit.size()));
    const auto nth = lit.begin() + static_cast<std::ptrdiff_t>(kWhitePercentile * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), nth, lit.end());
    return {scale, std::max(1.0, scale * *nth)};
}

/// sRGB bytes of each pixel's colour times factor(colour).
std::vector<std::uint8_t> encode(const Image& image, const auto& factor) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * image.pixels());
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const Rgb c = colour(image, i);
        const double scale = factor(c);
        for (int k = 0; k < 3; ++k)
            bytes.push_back(
                static_cast<std::uint8_t>(std::lround(255 * srgb_encode(static_cast<float>(scale * c[k])))));
    }
    return bytes;
}

} // namespace

float srgb_encode(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

std::vector<std::uint8_t> tonemap(const Image& image, const Image& exposed_for) {
    return encode(image, [curve = expose(exposed_for)](const Rgb& c) {
        const double l = std::max(0.0, curve.scale * luminance(c));
        // Equation 4 over l, so that black needs no exception.
        return curve.scale * (1 + l / (curve.white * curve.white)) / (1 + l);
    });
}

std::vector<std::uint8_t> expose_by(const Image& image, double stops) {
    return encode(image, [factor = std::exp2(stops)](const Rgb& /*colour*/) { return factor; });
}

} // namespace keyhole
