// What a picture tells about how it was made.
#pragma once

#include "core/render_stats.h"
#include "core/settings.h"

#include <map>
#include <string>

namespace keyhole {

/// Every setting as "key=value", in the order of the table, separated by spaces.
std::string settings_text(const Settings& settings);

/// String attributes for the EXR: program, command, scene, seed, settings, complete, seconds and rays of each stage and
/// of all, peak memory.
std::map<std::string, std::string> picture_metadata(const std::string& command_line, const std::string& scene,
                                                    const Settings& settings, const RenderStats& stats);

} // namespace keyhole
