// Scenes in pbrt-v4's text format. What is read, and how, is described in docs/pbrt.md.
#pragma once

#include "scene/load/load_yaml.h"

#include <string>
#include <vector>

namespace keyhole {

/// Whether a path ends in .pbrt.
bool is_pbrt(const std::string& path);

/// Reads a scene in the format of pbrt-v4, and most of v3's, with all files that it names.
/// @param warnings receives "file:line:column: directive: what is done instead" for what isn't read as it is meant,
/// once for each kind; may be null.
/// @param settings those that the file's sampler and integrator then overrule.
/// @throws InputErrors with "file:line:column: directive: what was found, what was expected" for every mistake, and for
/// what the picture would be wrong without, as far as it is independent of those before.
LoadedScene load_pbrt(const std::string& path, std::vector<std::string>* warnings, const Settings& settings = {});

} // namespace keyhole
