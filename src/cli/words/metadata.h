// What a picture tells about how it was made.
#pragma once

#include "core/render_stats.h"
#include "core/settings.h"
#include "scene/load/yaml/user_path_file.h"

#include <map>
#include <string>

namespace keyhole {

/// Every setting as "key=value", in the order of the table, separated by spaces.
std::string settings_text(const Settings& settings);

/// What tells renders apart: program, settings, seed, and hashes of the scene and of user paths.
std::map<std::string, std::string> render_identity(const Settings& settings, std::uint64_t scene_hash,
                                                   const UserPathFile& user_paths);

/// Further string attributes for the EXR: command, scene, samples, warnings, complete, seconds and rays of each stage
/// and of all, peak memory.
std::map<std::string, std::string> picture_metadata(const std::string& command_line, const std::string& scene,
                                                    const RenderStats& stats);

} // namespace keyhole
