// Pictures to look at.
#pragma once

#include "film/drawing.h"
#include "film/picture.h"

#include <optional>
#include <string>

namespace keyhole {

/// Writes an image as 8-bit sRGB, exposed by that many stops or, without them, tone-mapped. Atomic: see
/// write_file_atomically().
/// @throws InputError with the path and the reason.
void write_png(const std::string& path, const Image& image, std::optional<double> stops = std::nullopt);

/// Writes a picture as it is.
void write_png(const std::string& path, const Canvas& canvas);

/// A PNG file's content, of pixels with 3 channels (sRGB) or 1 (grey), 8 bits each.
/// @throws InputError for a size that PNG can't have.
std::string png_bytes(int width, int height, int channels, const std::vector<std::uint8_t>& pixels);

} // namespace keyhole
