// The layer of a picture that is looked at.
#pragma once

#include "film/picture.h"

#include <string>

namespace keyhole {

/// "beauty" of an EXR file. @throws InputError without one, or as read_exr().
Image read_beauty(const std::string& path);

/// The mean of two images of one size.
Image mean_of(Image a, const Image& b);

} // namespace keyhole
