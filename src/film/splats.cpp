#include "film/splats.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keyhole {
namespace {

constexpr std::size_t kChannels = 3;

} // namespace

SplatFilm::SplatFilm(int width, int height, const PixelFilter& filter)
    : width_(width), height_(height), filter_(filter),
      sums_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * kPerPixel) {
    assert(width > 0 && height > 0);
}

void SplatFilm::add(const Vec2& position, Layer layer, const Rgb& value) {
    const double reach = filter_.radius();
    const auto first = [reach](float x) { return static_cast<int>(std::ceil(x - 0.5 - reach)); };
    const auto last = [reach](float x) { return static_cast<int>(std::floor(x - 0.5 + reach)); };
    const auto centre = [](int x) { return static_cast<float>(x) + 0.5f; };
    for (int y = std::max(0, first(position.y)); y <= std::min(height_ - 1, last(position.y)); ++y) {
        const double row = filter_.density_1d(position.y - centre(y));
        for (int x = std::max(0, first(position.x)); x <= std::min(width_ - 1, last(position.x)); ++x) {
            const Rgb share = value * (filter_.density_1d(position.x - centre(x)) * row);
            const std::size_t pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
            FixedSum* sum = &sums_[(static_cast<std::size_t>(layer) * pixels() + pixel) * kChannels];
            for (int c = 0; c < static_cast<int>(kChannels); ++c) sum[c].add(share[c]);
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
