// Luminance of pictures, for measures of error.
#pragma once

#include "film/picture.h"

#include <cstddef>
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

/// Indices of the values that are left without the 0.1 % largest in size, NaN being the largest of all.
std::vector<std::size_t> without_outliers(const std::vector<double>& values);
/// Mean of these; NaN without any.
double trimmed_mean(const std::vector<double>& values);

/// Mean over the 3x3 neighbourhood of each pixel; the border repeats.
std::vector<double> smooth(const Grey& g);

} // namespace keyhole
