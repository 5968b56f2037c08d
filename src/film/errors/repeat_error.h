// Bias and variance of a method, apart, from pictures that differ in their seeds only.
#pragma once

#include "film/picture.h"

#include <vector>

namespace keyhole {

/// Relative squared errors, as `cross_trim` of ImageError: over S^2 + 0.01 mean(R)^2, S being the reference smoothed
/// over 3x3 pixels, without the 0.1 % of the pixels where the mean over the repeats is largest in size.
struct RepeatError {
    double error = 0;    ///< bias + variance: what to expect of one picture
    double bias = 0;     ///< squared, of the mean over infinitely many repeats; an unbiased estimate, so it may be < 0
    double variance = 0; ///< of one picture; NaN (as is the bias) where there is only one
    std::vector<double> each; ///< of each repeat, on the same pixels as the rest
};

/// @param repeats at least one. Luminance that is not finite counts as 0.
/// @param second_reference independent of the first; with it all is free of the references' noise. May be null.
/// @throws InputError if sizes differ.
RepeatError repeat_error(const std::vector<Image>& repeats, const Image& reference, const Image* second_reference);

} // namespace keyhole
