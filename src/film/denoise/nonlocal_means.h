// Pixels that look alike, averaged.
#pragma once

#include "core/progress.h"
#include "film/denoise/plane.h"

#include <array>
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

/// Pixels around a pixel whose likeness counts for that of the pixel.
constexpr int kPatch = 2;

/// Two independent pictures of the same, of three channels, and the variance of the luminance of either.
struct HalfPictures {
    std::array<std::array<Plane, 3>, 2> colours; ///< border: as Plane variance's
    std::array<Plane, 2> luminances;
    Plane variance; ///< border: the filter's reach and kPatch
};

/// Each of the halves as a mean over pixels up to `reach` away, weighed by how near they are, and by how alike their
/// surroundings look in the other half, beyond noise, and by guides: Rousselle, Knaus and Zwicker 2012, "Adaptive
/// rendering with non-local means filtering". Weights and what they weigh are independent, so that a bright sample
/// doesn't decide about itself.
/// @returns three channels each; of no use if `stop` is requested meanwhile. May be null.
std::array<Image, 2> filter_crosswise(const HalfPictures& halves, const FilterGuides& guides, int reach,
                                      const StopToken* stop);

} // namespace keyhole
