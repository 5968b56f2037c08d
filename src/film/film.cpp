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
    return {s.direct.x,  s.direct.y,  s.direct.z,  s.indirect.x, s.indirect.y,    s.indirect.z,
            s.caustic.x, s.caustic.y, s.caustic.z, s.albedo.x,   s.albedo.y,      s.albedo.z,
            s.normal.x,  s.normal.y,  s.normal.z,  s.depth,      s.photon_density};
}

std::size_t Film::index(int x, int y) const {
    assert(x >= 0 && x < width_ && y >= 0 && y < height_);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
}

void Film::add(int x, int y, const PixelSample& sample) {
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
    Pixel& p = pixels_[index(x, y)];
    for (std::size_t c = 0; c < kChannels; ++c) p.sums[c] += values[c];
    ++p.samples;
}

Picture Film::to_picture() const {
    Picture picture;
    picture.width = width_;
    picture.height = height_;
    Image& beauty = picture.layers["beauty"] = Image(width_, height_, 3);
    std::array<Image*, kLayers.size()> images{};
    for (std::size_t i = 0; i < kLayers.size(); ++i)
        images[i] = &(picture.layers[kLayers[i].name] = Image(width_, height_, kLayers[i].channels));
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        if (pixels_[p].samples == 0) continue;
        Channels mean = pixels_[p].sums;
        for (double& m : mean) m /= static_cast<double>(pixels_[p].samples);
        std::size_t first = 0;
        for (std::size_t i = 0; i < kLayers.size(); ++i) {
            const auto n = static_cast<std::size_t>(kLayers[i].channels);
            for (std::size_t c = 0; c < n; ++c) images[i]->data[p * n + c] = static_cast<float>(mean[first + c]);
            first += n;
        }
        for (std::size_t c = 0; c < 3; ++c)
            beauty.data[p * 3 + c] = static_cast<float>(mean[c] + mean[c + 3] + mean[c + 6]);
    }
    return picture;
}

Film::LuminanceSum Film::luminance_sum(std::size_t pixel) const {
    const Channels& s = pixels_[pixel].sums;
    const Rgb beauty(s[0] + s[3] + s[6], s[1] + s[4] + s[7], s[2] + s[5] + s[8]);
    return {luminance(beauty), static_cast<double>(pixels_[pixel].samples)};
}

std::uint64_t Film::empty_pixels() const {
    return static_cast<std::uint64_t>(std::ranges::count(pixels_, std::uint64_t{0}, &Pixel::samples));
}

void Film::report(RenderStats& stats) const {
    stats.values["empty pixels"] = static_cast<double>(empty_pixels());
    for (std::size_t i = 0; i < kLayers.size(); ++i) {
        if (dropped(i) == 0) continue;
        stats.warnings.push_back(fmt::format("{} samples were dropped: not finite, or negative, in layer '{}'",
                                             dropped(i), kLayers[i].name));
    }
}

} // namespace keyhole
