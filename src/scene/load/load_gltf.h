// Scenes in glTF 2.0 files. What is read, and how, is described in docs/gltf.md.
#pragma once

#include "scene/load/load_yaml.h"

#include <string>
#include <vector>

namespace keyhole {

/// Whether a path ends in .gltf or .glb.
bool is_gltf(const std::string& path);

/// Reads the default scene of a glTF 2.0 file (Khronos 2021): meshes, materials, textures, the first camera, and the
/// lights of KHR_lights_punctual. Without a camera one is placed that sees everything, and without any light there is a
/// white sky; both with a warning.
/// @param warnings receives "path: what is read otherwise than it is meant", each once; may be null.
/// @throws InputError "path: what was found, what was expected" for files that are missing or broken.
LoadedScene load_gltf(const std::string& path, std::vector<std::string>* warnings);

/// The bytes of a glTF file as Assimp reads them rightly: gltf/importable.h.
/// @throws InputError as load_gltf().
std::string importable_gltf(const std::string& path);

} // namespace keyhole
