// Pictures to look at.
#pragma once

#include "film/picture.h"

#include <string>

namespace keyhole {

/// Writes an image, tone-mapped, as 8-bit sRGB. Atomic: see write_file_atomically().
/// @throws InputError with the path and the reason.
void write_png(const std::string& path, const Image& image);

} // namespace keyhole
