// A part of a render as bytes to be sent.
#pragma once

#include "film/picture.h"

#include <vector>

namespace keyhole {

/// Size, metadata and sums of a picture, for a process of the same program.
std::vector<char> pack(const Picture& part);
Picture unpack(const std::vector<char>& bytes);

} // namespace keyhole
