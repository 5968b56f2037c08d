// Pictures to look at.
#pragma once

#include "film/drawing.h"
#include "film/picture.h"

#include <string>

namespace keyhole {

/// Writes an image, tone-mapped, as 8-bit sRGB. Atomic: see write_file_atomically().
/// @throws InputError with the path and the reason.
void write_png(const std::string& path, const Image& image);

/// Writes a picture as it is.
void write_png(const std::string& path, const Canvas& canvas);

} // namespace keyhole
