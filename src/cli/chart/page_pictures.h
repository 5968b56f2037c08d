// Pictures for the page of a chart, as data URIs.
#pragma once

#include "film/picture.h"

#include <string>

namespace keyhole {

/// Means over squares of `factor` pixels; rests at the right and at the bottom are left out.
Image shrunk(const Image& image, int factor);

/// The picture tone-mapped as the reference is, as a PNG in a data URI.
std::string picture_uri(const Image& image, const Image& reference);

/// The relative error of each pixel's luminance, signed, over |R| + 0.1 mean(R): a grey PNG in a data URI, whose byte
/// is 128 + 127 s sqrt(min(|e|, 1)), s being the sign.
std::string error_uri(const Image& image, const Image& reference);

} // namespace keyhole
