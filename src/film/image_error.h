// How far pictures are from a reference, or from each other.
#pragma once

#include "film/picture.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace keyhole {

/// Rec. 709 luminance of each pixel, row by row; of pictures of one channel, that channel.
struct Grey {
    std::size_t width, height;
    std::vector<double> y;

    explicit Grey(const Image& image);
};

/// What the square of a pixel's error is relative to, where `light` is there and the picture has this mean: what is
/// much darker than that has no relative error to speak of.
inline double error_unit(double light, double mean) { return light * light + 0.01 * mean * mean; }

/// Mean of the values; NaN without any.
double mean(const std::vector<double>& values);

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

/// Root of the mean of D^2 / (S^2 + 0.01 mean^2) on luminance, without the 0.1 % of the pixels where that is largest: D
/// is half of what two halves of the samples differ in, S the picture smoothed over 3x3 pixels. An estimate of the root
/// of what `keyhole diff` calls cross_trim, where all of a picture's error is noise of samples. What all samples share,
/// such as the photons of a map, it does not see.
/// @param picture a Film's.
/// Pixels that have samples of one half only are left out.
/// @returns none where halves are not known of a layer that has light, and of a black picture.
std::optional<double> sample_noise(const Picture& picture);

} // namespace keyhole
