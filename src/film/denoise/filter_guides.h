// What tells the filter where surfaces end.
#pragma once

#include "film/denoise/plane.h"

#include <vector>

namespace keyhole {

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

} // namespace keyhole
