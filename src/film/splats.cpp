#include "film/splats.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keyhole {
namespace {

constexpr std::size_t kChannels = 3, kPerPixel = 3 * kChannels;

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
    for (int y = std::max(0, first(position.y)); y <= std::min(height_ - 1, last(position.y)); ++y) {
        for (int x = std::max(0, first(position.x)); x <= std::min(width_ - 1, last(position.x)); ++x) {
            const Vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const Rgb share = value * filter_.density(position - centre);
            const std::size_t pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
            FixedSum* sum = &sums_[pixel * kPerPixel + static_cast<std::size_t>(layer) * kChannels];
            for (int c = 0; c < static_cast<int>(kChannels); ++c) sum[c].add(share[c]);
        }
    }
}

void SplatFilm::add_to(Picture& picture, double scale) const {
    Image& beauty = picture.layers.at("beauty");
    Image* const layers[] = {&picture.layers.at("direct"), &picture.layers.at("indirect"),
                             &picture.layers.at("caustic")};
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const auto value = static_cast<float>(scale * sums_[i].value());
        const std::size_t at = i / kPerPixel * kChannels + i % kChannels;
        layers[i % kPerPixel / kChannels]->data[at] += value;
        beauty.data[at] += value;
    }
}

} // namespace keyhole
