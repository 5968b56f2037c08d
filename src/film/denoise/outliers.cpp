#include "film/denoise/outliers.h"

#include "film/denoise/plane.h"

#include <cmath>

namespace keyhole {
namespace {

/// Of what all pixels of a window have, what one may have. Spread by nearness it adds half of what its neighbours have.
constexpr float kMostAdded = 0.2f;
/// So many times the mean over a window, itself among it, no outlier is below. And no more than so many of a window.
constexpr float kFarAboveMean = 8;
constexpr std::size_t kMostOfWindow = 6;
/// Of its brightness, what the half with less of it has at least: light that is there, not one sample's luck.
constexpr float kLeastInHalf = 0.1f;

/// The luminance above which a pixel is an outlier in the window around (x, y).
float bound(const Plane& luminance, int x, int y, int reach, std::vector<float>& window) {
    window.clear();
    for (int j = std::max(0, y - reach); j <= std::min(luminance.height() - 1, y + reach); ++j)
        for (int i = std::max(0, x - reach); i <= std::min(luminance.width() - 1, x + reach); ++i)
            window.push_back(luminance(i, j));
    const std::size_t kept = window.size() - std::min(kMostOfWindow, window.size() - 1);
    std::ranges::nth_element(window, window.begin() + static_cast<std::ptrdiff_t>(kept - 1));
    double sum = 0;
    for (std::size_t i = 0; i < kept; ++i) sum += window[i];
    return kMostAdded * static_cast<float>(sum / static_cast<double>(kept) * static_cast<double>(window.size()));
}

} // namespace

std::vector<Outlier> take_out_outliers(FilterPart& part, int reach) {
    const int width = part.mean.width, height = part.mean.height;
    const Plane luminance(width, height, 0, [&](int x, int y) { return luminance_at(part.mean, x, y); });
    const Plane mean = box_mean(width, height, 0, reach, luminance);
    std::vector<Outlier> found;
    std::vector<float> window;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (luminance(x, y) > kFarAboveMean * mean(x, y) &&
                luminance(x, y) > bound(luminance, x, y, reach, window)) {
                const float* p = part.mean.at(x, y);
                const bool confirmed = std::abs(luminance_at(part.noise, x, y)) < (1 - kLeastInHalf) * luminance(x, y);
                found.push_back({x, y, {p[0], p[1], p[2]}, confirmed});
            }
    // All at once: what is put into the place of one doesn't depend on that of another.
    for (const Outlier& o : found) {
        const float scale = bound(luminance, o.x, o.y, reach, window) /
                            (kMostAdded * static_cast<float>(window.size())) / luminance(o.x, o.y);
        for (std::size_t c = 0; c < 3; ++c) {
            part.mean.at(o.x, o.y)[c] = scale * o.mean[c];
            part.noise.at(o.x, o.y)[c] = 0;
        }
    }
    return found;
}

} // namespace keyhole
