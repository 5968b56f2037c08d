// glTF files in the part of the format that Assimp reads.
#pragma once

#include "scene/load/gltf/document.h"

namespace keyhole::gltf {

/// The bytes of a file with the same meshes at the same places, in which
/// - each material has its number for a name, as readers number them in an order of their own,
/// - all attributes are floats, and none are sparse: Assimp takes the bytes of integers for those of floats, and rows
///   with gaps between them for tight ones,
/// - instances are nodes,
/// - there are no lights, cameras, skins and animations.
/// @throws InputError for attributes that are broken, and as check_extensions().
std::string importable(const Document& document);

} // namespace keyhole::gltf
