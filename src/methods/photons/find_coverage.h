// Whether a scene has light that final gather would not find.
#pragma once

#include "core/progress.h"
#include "core/settings.h"
#include "sampling/paths/gather_coverage.h"

#include <optional>

namespace keyhole {

struct CoverageFound {
    double beyond = 0;                      ///< light_outside_coverage(), 0 if nobody asked
    std::optional<GatherCoverage> coverage; ///< where more light ends beyond it than final gather could find
};

/// Number of eye paths that gather coverage is found by: fewer where the importance of the whole render rests on few.
std::int64_t coverage_paths(const Settings& settings);

/// Follows from the scene, coverage_paths() and the settings `gather_coverage`, `plan` and `max_depth` alone, so that
/// passes, their shares on other machines and saved maps agree. @throws Interrupted
CoverageFound find_coverage(const Scene& scene, const Settings& settings, const RunContext& context = {});

} // namespace keyhole
