// What the module with OpenImageIO offers. Built with the same compiler as its user, so that C++ types may cross.
#pragma once

#include "scene/images/image.h"

namespace keyhole {

/// Reads a file. False: `error` says why. Never throws.
using ReadImage = bool(const std::string& path, ImagePart part, TextureImage& image, std::string& error) noexcept;

constexpr const char* kImageModule = "libkeyhole_oiio.so";
constexpr const char* kReadImageSymbol = "keyhole_read_image_part";

} // namespace keyhole
