// One channel of a picture, with a border for neighbours.
#pragma once

#include "core/parallel.h"
#include "film/picture.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace keyhole {

/// Row-major floats; `border` more on every side repeat those at the edge.
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

} // namespace keyhole
