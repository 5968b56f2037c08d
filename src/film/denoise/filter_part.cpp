#include "film/denoise/filter_part.h"

#include "film/denoise/plane.h"

namespace keyhole {
namespace {

/// Of what all pixels of a window have, what one may have. Spread by nearness it adds half of what its neighbours have.
constexpr float kMostAdded = 0.2f;
/// So many times the mean over a window, itself among it, no outlier is below. And no more than so many of a window.
constexpr float kFarAboveMean = 8;
constexpr std::size_t kMostOfWindow = 6;
/// Of its brightness, what the half with less of it has at least: light that is there, not one sample's luck.
constexpr float kLeastInHalf = 0.1f;

/// The mean luminance of a window around (x, y) without its brightest pixels. `window` receives all of it.
float mean_of_most(const Plane& luminance, int x, int y, int reach, std::vector<float>& window) {
    window.clear();
    for (int j = std::max(0, y - reach); j <= std::min(luminance.height() - 1, y + reach); ++j)
        for (int i = std::max(0, x - reach); i <= std::min(luminance.width() - 1, x + reach); ++i)
            window.push_back(luminance(i, j));
    const std::size_t kept = window.size() - std::min(kMostOfWindow, window.size() - 1);
    std::ranges::nth_element(window, window.begin() + static_cast<std::ptrdiff_t>(kept - 1));
    double sum = 0;
    for (std::size_t i = 0; i < kept; ++i) sum += window[i];
    return static_cast<float>(sum / static_cast<double>(kept));
}

} // namespace

std::vector<Outlier> take_out_outliers(FilterPart& part, int reach) {
    const int width = part.mean.width, height = part.mean.height;
    const Plane luminance(width, height, 0, [&](int x, int y) { return luminance_at(part.mean, x, y); });
    const Plane mean = box_mean(width, height, 0, reach, luminance);
    std::vector<Outlier> found;
    std::vector<float> window;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float light = luminance(x, y);
            if (light <= kFarAboveMean * mean(x, y)) continue;
            const float rest = mean_of_most(luminance, x, y, reach, window);
            if (light <= kMostAdded * rest * static_cast<float>(window.size())) continue;
            float *p = part.mean.at(x, y), *noise = part.noise.at(x, y);
            const bool confirmed = std::abs(luminance_at(part.noise, x, y)) < (1 - kLeastInHalf) * light;
            found.push_back({x, y, {p[0], p[1], p[2]}, confirmed});
            for (int c = 0; c < 3; ++c) p[c] *= rest / light;
            std::fill_n(noise, 3, 0.0f);
        }
    }
    return found;
}

} // namespace keyhole
