// What a scene consists of.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace keyhole {

/// Loads the scene and builds it as for a render. The keys are listed in docs/command-line.md.
/// @throws InputError as load() does.
nlohmann::ordered_json scene_info(const std::string& path);

} // namespace keyhole
