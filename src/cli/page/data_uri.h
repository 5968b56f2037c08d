// Files inside of pages.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace keyhole {

/// A PNG, of pixels with 3 channels (sRGB) or 1 (grey).
std::string png_uri(int width, int height, int channels, const std::vector<std::uint8_t>& pixels);

} // namespace keyhole
