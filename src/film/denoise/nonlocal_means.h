// Pixels that look alike, averaged.
#pragma once

#include "core/progress.h"
#include "film/denoise/filter_guides.h"

#include <array>

namespace keyhole {

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
