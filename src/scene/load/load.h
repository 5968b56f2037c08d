// Scenes from files of any format that we read.
#pragma once

#include "scene/load/load_yaml.h"

#include <string>
#include <vector>

namespace keyhole {

/// Reads a scene: pbrt's format where the path ends in .pbrt, glTF where in .gltf or .glb, else YAML.
/// @param overrides `key=value` settings, applied in order after those of the file.
/// @param warnings receives what isn't read as it is meant, one line each; may be null.
/// @throws InputErrors with "file:line:column: what was found, what was expected" for every mistake in the files, as
/// far as it is independent of those before.
LoadedScene load(const std::string& path, const std::vector<std::string>& overrides = {},
                 std::vector<std::string>* warnings = nullptr);

} // namespace keyhole
