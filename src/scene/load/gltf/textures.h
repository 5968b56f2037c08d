// Textures of glTF materials, and the factors on them.
#pragma once

#include "scene/load/gltf/document.h"
#include "scene/texture.h"

#include <memory>

namespace keyhole::gltf {

/// The picture that a reference to a texture names. T: Rgb, or double with the `channel` of ImageOptions.
/// @throws InputError for pictures in formats that aren't read.
template <class T>
std::shared_ptr<const Texture<T>> picture(Document& document, const Json& reference, Encoding encoding,
                                          int channel = -1);

/// The colour under the key `factor`, white if none is given, perhaps times the picture under `texture`. This and the
/// next have factors within 0 and 1, and warn where the file doesn't.
ColorTexture color(Document& document, const Json& object, const char* factor, const char* texture,
                   std::size_t numbers = 3);

/// A number, perhaps times a channel of a texture.
FloatTexture number(Document& document, const Json& object, const char* factor, double otherwise, const char* texture,
                    int channel);

} // namespace keyhole::gltf
