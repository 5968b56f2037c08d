#include "film/splats.h"

#include "core/integer_power.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace keyhole {
namespace {

constexpr std::size_t kChannels = 3;
constexpr std::array kLayerNames{"direct", "indirect", "caustic"}; // of SplatFilm::Layer

/// Parts of the filter's reach between which it is taken for linear: within 1e-6 of itself, at a fraction of the cost
/// of an exponential. There are several for each splat.
constexpr int kNodes = 1024;

} // namespace

SplatFilm::SplatFilm(int width, int height, const PixelFilter& filter, double brightness)
    : width_(width), height_(height), reach_(filter.radius()), unit_(power_of_two_near(brightness)),
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
            const Rgb share = value * (weight * rows.weights[y] / unit_);
            for (int c = 0; c < static_cast<int>(kChannels); ++c) (sum++)->add(share[c]);
        }
    }
}

std::array<double, SplatFilm::kPerPixel> SplatFilm::sums(std::size_t pixel) const {
    std::array<double, kPerPixel> values{};
    for (std::size_t i = 0; i < kPerPixel; ++i)
        values[i] = sums_[(i / kChannels * pixels() + pixel) * kChannels + i % kChannels].value() * unit_;
    return values;
}

void SplatFilm::clear() {
    for (FixedSum& sum : sums_) sum.take();
}

SplattedLight::SplattedLight(int width, int height)
    : pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

void SplattedLight::add(const SplatFilm& unit, double scale, Half half) {
    assert(unit.pixels() == pixels_.size());
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        auto drawn = unit.sums(p);
        for (double& value : drawn) value *= scale;
        pixels_[p].add(drawn, half);
    }
}

void SplattedLight::merge(const SplattedLight& other) {
    assert(other.pixels_.size() == pixels_.size());
    for (std::size_t p = 0; p < pixels_.size(); ++p) pixels_[p].merge(other.pixels_[p]);
}

void SplattedLight::clear() { std::ranges::fill(pixels_, Pixel{}); }

AccumulatorState SplattedLight::words() const { return accumulator_state(pixels_); }

void SplattedLight::set_words(const AccumulatorState& words) { set_pixels(pixels_, words); }

double SplattedLight::mean_luminance(std::size_t pixel) const {
    const auto m = pixels_[pixel].means();
    return luminance(Rgb(m[0] + m[3] + m[6], m[1] + m[4] + m[7], m[2] + m[5] + m[8]));
}

void SplattedLight::add_to(Picture& picture) const {
    Image& beauty = picture.layers.at("beauty");
    std::array<Image*, 3> layers{}, noise{};
    for (std::size_t i = 0; i < layers.size(); ++i) {
        layers[i] = &picture.layers.at(kLayerNames[i]);
        noise[i] = &picture.layers.at(noise_layer(kLayerNames[i]));
    }
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        const auto mean = pixels_[p].means(), difference = pixels_[p].half_differences();
        for (std::size_t c = 0; c < mean.size(); ++c) {
            const std::size_t layer = c / 3, at = p * 3 + c % 3;
            const auto value = static_cast<float>(mean[c]);
            layers[layer]->data[at] += value;
            beauty.data[at] += value;
            noise[layer]->data[at] += static_cast<float>(difference[c]);
        }
    }
}

} // namespace keyhole
