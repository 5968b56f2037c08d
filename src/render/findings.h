// What the renders of one scene have to find out about it.
#pragma once

#include "photonmap/surface_patches.h"
#include "render/find_reach.h"
#include "render/plan.h"

#include <optional>

namespace keyhole {

/// Found out by the first render that asks, and used by those that follow: of the same scene, with settings that differ
/// in effort and seed alone.
struct Findings {
    std::optional<SurfacePatches> patches;
    std::optional<RenderPlan> plan;  ///< of methods with photon maps, standard photon mapping apart
    std::optional<ReachFound> reach; ///< where there is no plan

    /// So that how far gather rays come is found out anew where it matters: trials spend few rays on it.
    void forget_reach() {
        if (plan && plan->reach) plan.reset();
        reach.reset();
    }
};

} // namespace keyhole
