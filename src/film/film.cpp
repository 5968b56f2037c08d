#include "film/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keyhole {

Film::Film(int width, int height, const PixelFilter& filter)
    : width_(width), height_(height), filter_(filter),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    assert(width > 0 && height > 0);
}

Film::Channels Film::channels(const PixelSample& s) {
    return {s.direct.x,  s.direct.y, s.direct.z, s.indirect.x, s.indirect.y, s.indirect.z, s.caustic.x, s.caustic.y,
            s.caustic.z, s.albedo.x, s.albedo.y, s.albedo.z,   s.normal.x,   s.normal.y,   s.normal.z,  s.depth};
}

std::size_t Film::index(int x, int y) const {
    assert(x >= 0 && x < width_ && y >= 0 && y < height_);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
}

void Film::add(int x, int y, const PixelSample& sample, Half half) {
    const Channels values = channels(sample);
    bool good = true;
    auto value = values.begin();
    for (std::size_t i = 0; i < kLayers.size(); ++i) {
        const auto end = value + kLayers[i].channels;
        if (!std::all_of(value, end, [&](double v) { return std::isfinite(v) && (v >= 0 || kLayers[i].is_signed); })) {
            dropped_[i].fetch_add(1, std::memory_order_relaxed);
            good = false;
        }
        value = end;
    }
    if (!good) return;
    pixels_[index(x, y)].add(values, half);
}

void Film::merge(const Film& other) {
    assert(other.pixels_.size() == pixels_.size());
    for (std::size_t p = 0; p < pixels_.size(); ++p) pixels_[p].merge(other.pixels_[p]);
    for (std::size_t i = 0; i < kLayers.size(); ++i) dropped_[i] += other.dropped(i);
}

void Film::clear() {
    std::ranges::fill(pixels_, Pixel{});
    for (auto& n : dropped_) n = 0;
}

AccumulatorState Film::words() const { return accumulator_state(pixels_); }

void Film::set_words(const AccumulatorState& words) { set_pixels(pixels_, words); }

Picture Film::to_picture() const {
    Picture picture;
    picture.width = width_;
    picture.height = height_;
    Image& beauty = picture.layers["beauty"] = Image(width_, height_, 3);
    std::array<Image*, kLayers.size()> images{}, noise{};
    for (std::size_t i = 0; i < kLayers.size(); ++i) {
        const auto& [name, channels, is_signed] = kLayers[i];
        images[i] = &(picture.layers[name] = Image(width_, height_, channels));
        noise[i] = &(picture.layers[noise_layer(name)] = Image(width_, height_, channels));
    }
    const auto set = [](const auto& layers, std::size_t p, const Channels& values) {
        auto value = values.begin();
        for (Image* layer : layers)
            for (int c = 0; c < layer->channels; ++c)
                layer->data[p * static_cast<std::size_t>(layer->channels) + static_cast<std::size_t>(c)] =
                    static_cast<float>(*value++);
    };
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        if (pixels_[p].samples() == 0) continue;
        const Channels mean = pixels_[p].means();
        set(images, p, mean);
        set(noise, p, pixels_[p].half_differences());
        for (std::size_t c = 0; c < 3; ++c)
            beauty.data[p * 3 + c] = static_cast<float>(mean[c] + mean[c + 3] + mean[c + 6]);
    }
    return picture;
}

double Film::mean_luminance(std::size_t pixel) const {
    const Channels m = pixels_[pixel].means();
    return luminance(Rgb(m[0] + m[3] + m[6], m[1] + m[4] + m[7], m[2] + m[5] + m[8]));
}

double Film::samples_per_pixel() const {
    double sum = 0;
    for (const Pixel& p : pixels_) sum += static_cast<double>(p.samples());
    return sum / static_cast<double>(pixels_.size());
}

std::uint64_t Film::empty_pixels() const {
    return static_cast<std::uint64_t>(std::ranges::count(pixels_, std::uint64_t{0}, &Pixel::samples));
}

void Film::report(RenderStats& stats) const {
    stats.no_samples = empty_pixels();
    for (std::size_t i = 0; i < kLayers.size(); ++i) {
        if (dropped(i) == 0) continue;
        stats.warn(Doubt::samples, fmt::format("{} samples were dropped: not finite, or negative, in layer '{}'",
                                               dropped(i), kLayers[i].name));
    }
}

} // namespace keyhole
