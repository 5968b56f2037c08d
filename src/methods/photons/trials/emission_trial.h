// Whether light paths bring more where they begin as it was learned.
#pragma once

#include "core/progress.h"
#include "photonmap/photon_weighing.h"
#include "sampling/guidance/learned/learned_emission.h"

#include <vector>

namespace keyhole {

struct EmissionTrial {
    /// Of the visible power of photons whose light paths begin as it was learned, the second moment over that of those
    /// which begin by power; 1 where none is seen.
    double second_moment = 1;
    /// Visible power of caustics by emitter, over all visible power, that learned paths find less than half as often as
    /// those by power.
    std::vector<double> hidden{};
};

/// Paths from the eye learn nothing of light that they can't find, such as a small lamp's through glass: it would come
/// from few light paths, of many times the power. Neither kind of light path tells of the other what it seldom finds
/// itself; so both are drawn, and each photon counts for both kinds by the balance heuristic (Veach 1997, 9.2.2). The
/// same on any number of threads.
EmissionTrial try_emission(const Scene& scene, const EmissionGuide& guide, const StorageRule& rule,
                           const LearnedEmission& learned, std::uint64_t seed, const RunContext& context);

} // namespace keyhole
