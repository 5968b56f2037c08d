// How noisy a picture's samples have left it, without a reference.
#pragma once

#include "film/picture.h"

#include <optional>

namespace keyhole {

/// Root of the mean of D^2 / (S^2 + 0.01 mean^2) on luminance, without the 0.1 % of the pixels where that is largest: D
/// is half of what two halves of the samples differ in, S the picture smoothed over 3x3 pixels. An estimate of the root
/// of what `keyhole diff` calls cross_trim, where all of a picture's error is noise of samples. What all samples share,
/// such as the photons of a map, it does not see.
/// @param picture a Film's.
/// Pixels that have samples of one half only are left out.
/// @returns none where halves are not known of a layer that has light, and of a black picture.
std::optional<double> sample_noise(const Picture& picture);

} // namespace keyhole
