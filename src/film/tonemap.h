// From radiance to what a screen shows.
#pragma once

#include "film/picture.h"

#include <cstdint>
#include <vector>

namespace keyhole {

/// Encodes a value in [0,1] with the sRGB transfer function (IEC 61966-2-1); clamps others, and NaN to 0.
float srgb_encode(float linear);

/// The global operator of Reinhard, Stark, Shirley and Ferwerda 2002, equations 1, 2 and 4, on luminance; colours keep
/// their ratios until they clip. Key 0.18. The log-average leaves black pixels out: one would pull it to 0. The white
/// point is the 99.5th percentile of scaled luminance, so that lamps and single bright pixels don't dim the rest, but
/// at least 1. Images of one channel are taken as grey.
/// @returns 3 bytes a pixel, sRGB. Pixels that are not finite become black.
/// @param exposed_for the image whose luminance sets scale and white point: `image` itself, or one that it is to be
/// compared with.
std::vector<std::uint8_t> tonemap(const Image& image, const Image& exposed_for);
/// Without a curve: radiance times 2^stops in sRGB, clipped to [0,1]. Nothing in the picture moves it.
std::vector<std::uint8_t> expose_by(const Image& image, double stops);
inline std::vector<std::uint8_t> tonemap(const Image& image) { return tonemap(image, image); }

} // namespace keyhole
