// Pixels that look alike, averaged.
#pragma once

#include "core/parallel.h"
#include "core/progress.h"
#include "film/picture.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace keyhole {

/// One channel of a picture, with a border for neighbours: row-major floats; `border` more on every side repeat those
/// at the edge.
class Plane {
  public:
    /// @param value value(x, y) of the pixels within.
    template <class Value>
    Plane(int width, int height, int border, Value&& value)
        : width_(width), height_(height), border_(border), stride_(width + 2 * border),
          data_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height + 2 * border)) {
        parallel_for(height + 2 * border, [&](std::int64_t row) {
            const int y = static_cast<int>(row) - border;
            for (int x = -border; x < width + border; ++x)
                *at(x, y) = value(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1));
        });
    }

    int width() const { return width_; }
    int height() const { return height_; }
    /// Pixel (x, y); the row goes on to both sides of it.
    const float* at(int x, int y) const { return data_.data() + index(x, y); }
    float operator()(int x, int y) const { return *at(x, y); }

  private:
    float* at(int x, int y) { return data_.data() + index(x, y); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y + border_) * static_cast<std::size_t>(stride_) +
               static_cast<std::size_t>(x + border_);
    }

    int width_, height_, border_, stride_;
    std::vector<float> data_;
};

/// The mean over the square of pixels up to `reach` away, as far as they lie in the plane.
template <class Value> Plane box_mean(int width, int height, int border, int reach, Value&& value) {
    const Plane plain(width, height, 0, value);
    const auto mean = [](int at, int size, int reach, auto&& term) {
        const int first = std::max(0, at - reach), last = std::min(size - 1, at + reach);
        float sum = 0;
        for (int i = first; i <= last; ++i) sum += term(i);
        return sum / static_cast<float>(last - first + 1);
    };
    const Plane rows(width, height, 0,
                     [&](int x, int y) { return mean(x, width, reach, [&](int i) { return plain(i, y); }); });
    return {width, height, border,
            [&](int x, int y) { return mean(y, height, reach, [&](int i) { return rows(x, i); }); }};
}

/// Albedo, normal and depth of a picture, as what the pixels of two places differ in. Rousselle, Manzi and Zwicker
/// 2013, "Robust denoising using feature and color information", section 4.
class FilterGuides {
  public:
    /// @param picture with these layers, and their noise.
    FilterGuides(const Picture& picture, int border);

    /// distance[i] = the largest over all channels of how far pixel (x + i, y) and the one (dx, dy) from it are apart,
    /// squared, beyond their noise, over what a channel varies around there; at least 0. For i in [0, n).
    void distances(int x, int y, int dx, int dy, int n, float* distance) const;

  private:
    struct Channel {
        Plane value, variance, precision; ///< the last: one over the squared difference that counts as 1
    };
    void add(int width, int height, int border, auto&& value, auto&& noise);

    std::vector<Channel> channels_;
};

/// Pixels around a pixel whose likeness counts for that of the pixel.
constexpr int kPatch = 2;

/// Two independent pictures of the same, of three channels, and the variance of the luminance of either. A pixel of one
/// sample is in one of them alone; at least one of them has it.
struct HalfPictures {
    std::array<Plane, 2> there; ///< what a pixel counts, 0 where a half lacks it; border: as Plane variance's
    std::array<std::array<Plane, 3>, 2> colours; ///< times `there`
    std::array<Plane, 2> luminances;
    Plane variance; ///< border: the filter's reach and kPatch
};

/// Each of the halves as a mean over pixels up to `reach` away, weighed by how near they are, and by how alike their
/// surroundings look in the other half, beyond noise, and by guides: Rousselle, Knaus and Zwicker 2012, "Adaptive
/// rendering with non-local means filtering". Weights and what they weigh are independent, so that a bright sample
/// doesn't decide about itself. A pixel that one half lacks is a mean of other pixels there; as far as these weigh less
/// than it would itself, what it is in the other half stands in.
/// @returns three channels each; of no use if `stop` is requested meanwhile. May be null.
std::array<Image, 2> filter_crosswise(const HalfPictures& halves, const FilterGuides& guides, int reach,
                                      const StopToken* stop);

} // namespace keyhole
