// Whether a scene has light that final gather would not find.
#pragma once

#include "core/progress.h"
#include "core/settings.h"
#include "sampling/reach.h"

#include <optional>

namespace keyhole {

struct ReachFound {
    double beyond = 0;          ///< light_beyond_reach(), 0 if nobody asked
    std::optional<Reach> reach; ///< where more light ends beyond it than final gather could find
};

/// Eye paths that the reach is found by: fewer where the importance of the whole render rests on few.
std::int64_t reach_paths(const Settings& settings);

/// Follows from the scene, reach_paths() and the settings `reach`, `plan` and `max_depth` alone, so that passes, their
/// shares on other machines and saved maps agree. @throws Interrupted
ReachFound find_reach(const Scene& scene, const Settings& settings, const RunContext& context = {});

} // namespace keyhole
