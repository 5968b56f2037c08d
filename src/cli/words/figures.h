// The figures of a render, in words.
#pragma once

#include "core/render_stats.h"

#include <map>
#include <string>

namespace keyhole {

/// All that are known but those that have keys of their own in `--stats`.
std::map<std::string, double> figures(const RenderStats& stats);

} // namespace keyhole
