// What the renders of one scene have to find out about it.
#pragma once

#include "methods/photons/find_coverage.h"
#include "methods/photons/photon_sampler.h"
#include "methods/photons/plan.h"
#include "photonmap/surface/surface_patches.h"

#include <optional>

namespace keyhole {

/// Found out by the first render that asks, and used by those that follow: of the same scene, with settings that differ
/// in effort and seed alone.
struct Findings {
    std::optional<SurfacePatches> patches;
    std::optional<RenderPlan> plan;        ///< of methods with photon maps, standard photon mapping apart
    std::optional<CoverageFound> coverage; ///< where there is no plan
    std::optional<WorkShares> shares;      ///< of cps
    double gain_by_openings = 1; ///< by how much fewer light paths do as well if they are led through what was found

    /// So that how far gather rays come is found out anew where it matters: trials spend few rays on it.
    void forget_coverage() {
        if (plan && plan->coverage) plan.reset();
        coverage.reset();
    }
};

} // namespace keyhole
