// Statistics of a render as JSON.
#pragma once

#include "core/render_stats.h"

#include <nlohmann/json.hpp>

namespace keyhole {

/// Keys are the members' names; numbers that are not finite become null.
nlohmann::ordered_json stats_json(const RenderStats& stats);

} // namespace keyhole
