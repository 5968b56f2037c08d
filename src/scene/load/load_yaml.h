// Scene files. Their format is described in docs/scene-format.md.
#pragma once

#include "core/settings.h"
#include "scene/load/yaml/settings_text.h"
#include "scene/load/yaml/user_path_file.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace keyhole {

/// What a scene file says.
struct LoadedScene {
    SceneDescription description;
    Settings settings;
    UserPathFile user_paths;   ///< of the file that the scene names; none otherwise
    std::size_t instances = 0; ///< groups or objects placed, counted as often as they are
};

/// Reads a scene file, the files it includes and its meshes.
/// @param overrides `key=value` settings, applied in order after those of the file.
/// @param warnings receives what isn't read as it is meant, one line each; may be null.
/// @throws InputErrors with "file:line:column: what was found, what was expected" for every mistake in the files, as
/// far as it is independent of those before.
LoadedScene load_scene(const std::string& path, const std::vector<std::string>& overrides = {},
                       std::vector<std::string>* warnings = nullptr);

} // namespace keyhole
