// User paths as a person gives them: what the file's reader made of an entry with several numbers of bounces becomes
// one entry again.
#pragma once

#include "scene/load/yaml/user_path_file.h"
#include "scene/scene.h"

#include <nlohmann/json.hpp>

namespace keyhole {

/// A list of entries: name, weight, beta [degrees], points, bounces, patch and tolerance as in the file; `paths`, the
/// names of the paths that it stands for; what became of it in the scene: `error`, or `signature` and `seen`.
nlohmann::ordered_json user_path_entries(const UserPathFile& file, const Scene& scene);

/// The paths of `file` that work in the scene.
UserPathFile working_paths(const UserPathFile& file, const Scene& scene);

} // namespace keyhole
