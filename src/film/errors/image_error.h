// How far a picture is from a reference.
#pragma once

#include "film/picture.h"

#include <cstdint>
#include <optional>

namespace keyhole {

/// Measures of a picture I against a reference R, on Rec. 709 luminance. NaN where a measure does not exist (nothing
/// lit, no whole block).
struct ImageError {
    double relmse = 0;      ///< mean of (I - R)^2 / (R^2 + 0.01 mean(R)^2)
    double relmse_trim = 0; ///< the same without the worst 0.1 % of the pixels
    double rms_rel = 0;     ///< sqrt(mean(((I - R) / R)^2)) where R > 1e-4 mean(R): the measure of Fan et al. 2005
    double ratio = 0;       ///< mean(I) / mean(R)
    /// Root mean square of the relative error of 16x16 block means; rests at the border left out. A block's reference
    /// is at least 1e-6 mean(R), so that a block black in both pictures counts as an error of 1, not 0: a picture with
    /// black blocks is not at distance 0 from itself.
    double block = 0;
    std::uint64_t bad = 0; ///< pixels of I that are negative or not finite; the latter count as 0 in all measures
    /// With a second, independent reference, whose mean with the first is R then: mean of
    /// (I - R1)(I - R2) / (S^2 + 0.01 mean(R)^2), S being R smoothed over 3x3 pixels. Free of the references' own
    /// noise.
    std::optional<double> cross;
    std::optional<double> cross_trim; ///< without the 0.1 % of the pixels that are largest in size
};

/// Compares the images, of one channel (luminance) or at least three (R, G, B first).
/// @throws InputError if sizes differ.
ImageError image_error(const Image& picture, const Image& reference, const Image* second_reference = nullptr);

} // namespace keyhole
