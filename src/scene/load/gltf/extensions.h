// Extensions that glTF files say they need or have.
#pragma once

#include "scene/load/gltf/document.h"

namespace keyhole::gltf {

/// Warns of extensions that are left out, but for those of materials, which materials tell of.
/// @throws InputError for those that the file requires, and for compressed bytes without plain ones.
void check_extensions(const Document& document);

} // namespace keyhole::gltf
