#include "film/denoise/filter_guides.h"

#include <cmath>

namespace keyhole {
namespace {

/// Differences below a tenth of a channel's range are no edges.
constexpr float kLeastSquare = 0.01f;
/// The difference that counts as 1, over what a channel varies around there.
constexpr float kGuideBandwidth = 0.8f;
/// Pixels around one over which the noise of its channels is averaged.
constexpr int kReachOfGuideNoise = 1;

} // namespace

FilterGuides::FilterGuides(const Picture& picture, int border) {
    const int width = picture.width, height = picture.height;
    for (const char* name : {"albedo", "normal"}) {
        const Image &layer = picture.layers.at(name), &noise = picture.layers.at(noise_layer(name));
        for (int c = 0; c < 3; ++c)
            add(
                width, height, border, [&](int x, int y) { return layer.at(x, y)[c]; },
                [&](int x, int y) { return noise.at(x, y)[c]; });
    }
    // Depth goes without bound: z / (z + mean) lies between 0 and 1 in scenes of any size.
    const Image &depth = picture.layers.at("depth"), &noise = picture.layers.at(noise_layer("depth"));
    double sum = 0;
    for (const float z : depth.data) sum += z;
    const float mean = std::max(1e-30f, static_cast<float>(sum / static_cast<double>(depth.data.size())));
    add(
        width, height, border,
        [&](int x, int y) {
            const float z = *depth.at(x, y);
            return z / (z + mean);
        },
        [&](int x, int y) {
            const float z = *depth.at(x, y);
            return *noise.at(x, y) * mean / ((z + mean) * (z + mean));
        });
}

void FilterGuides::add(int width, int height, int border, auto&& value, auto&& noise) {
    Plane values(width, height, border, value);
    Plane variance = box_mean(width, height, border, kReachOfGuideNoise, [&](int x, int y) {
        const float d = noise(x, y);
        return d * d;
    });
    Plane precision(width, height, border, [&](int x, int y) {
        // An edge within a pixel's reach is met by all its neighbours.
        const float across = (values(std::min(x + 1, width - 1), y) - values(std::max(x - 1, 0), y)) / 2,
                    down = (values(x, std::min(y + 1, height - 1)) - values(x, std::max(y - 1, 0))) / 2;
        const float scale = std::max({kLeastSquare, variance(x, y), across * across + down * down});
        return 1 / (kGuideBandwidth * kGuideBandwidth * scale);
    });
    channels_.push_back({std::move(values), std::move(variance), std::move(precision)});
}

void FilterGuides::distances(int x, int y, int dx, int dy, int n, float* distance) const {
    std::fill_n(distance, n, 0.0f);
    for (const Channel& c : channels_) {
        const float *here = c.value.at(x, y), *there = c.value.at(x + dx, y + dy);
        const float *noise = c.variance.at(x, y), *other_noise = c.variance.at(x + dx, y + dy);
        const float* precision = c.precision.at(x, y);
        for (int i = 0; i < n; ++i) {
            const float difference = here[i] - there[i];
            const float beyond = difference * difference - (noise[i] + std::min(noise[i], other_noise[i]));
            distance[i] = std::max(distance[i], beyond * precision[i]);
        }
    }
}

} // namespace keyhole
