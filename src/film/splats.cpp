#include "film/splats.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keyhole {
namespace {

constexpr std::size_t kChannels = 3;

/// Parts of the filter's reach between which it is taken for linear: within 1e-6 of itself, at a fraction of the cost
/// of an exponential. There are several for each splat.
constexpr int kNodes = 1024;

} // namespace

SplatFilm::SplatFilm(int width, int height, const PixelFilter& filter)
    : width_(width), height_(height), reach_(filter.radius()),
      sums_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * kPerPixel) {
    assert(width > 0 && height > 0);
    for (int i = 0; i <= kNodes; ++i) filter_.push_back(filter.density_1d(reach_ * i / kNodes));
    filter_.push_back(filter_.back()); // right of the last node
}

SplatFilm::Footprint SplatFilm::footprint(float position, int size) const {
    const int last = std::min(size - 1, static_cast<int>(std::floor(position - 0.5 + reach_)));
    Footprint f;
    f.first = std::max(0, static_cast<int>(std::ceil(position - 0.5 - reach_)));
    for (int i = f.first; i <= last; ++i) {
        const double x = std::abs(position - (static_cast<float>(i) + 0.5f)) / reach_ * kNodes;
        const auto node = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(kNodes));
        f.weights.push_back(filter_[node] + (filter_[node + 1] - filter_[node]) * (x - static_cast<double>(node)));
    }
    return f;
}

void SplatFilm::add(const Vec2& position, Layer layer, const Rgb& value) {
    const Footprint columns = footprint(position.x, width_), rows = footprint(position.y, height_);
    const auto width = static_cast<std::size_t>(width_);
    FixedSum* const corner =
        sums_.data() + (static_cast<std::size_t>(layer) * pixels() + static_cast<std::size_t>(rows.first) * width +
                        static_cast<std::size_t>(columns.first)) *
                           kChannels;
    for (std::size_t y = 0; y < rows.weights.size(); ++y) {
        FixedSum* sum = corner + y * width * kChannels;
        for (const double weight : columns.weights) {
            const Rgb share = value * (weight * rows.weights[y]);
            for (int c = 0; c < static_cast<int>(kChannels); ++c) (sum++)->add(share[c]);
        }
    }
}

std::array<double, SplatFilm::kPerPixel> SplatFilm::sums(std::size_t pixel) const {
    std::array<double, kPerPixel> values{};
    for (std::size_t i = 0; i < kPerPixel; ++i)
        values[i] = sums_[(i / kChannels * pixels() + pixel) * kChannels + i % kChannels].value();
    return values;
}

void SplatFilm::clear() {
    for (FixedSum& sum : sums_) sum.take();
}

} // namespace keyhole
