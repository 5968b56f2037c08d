// Trials of where light paths begin, and of how chains and light paths share the work.
#pragma once

#include "core/progress.h"
#include "methods/photons/photon_sampler.h"
#include "photonmap/photon_weighing.h"
#include "sampling/guidance/learned/learned_emission.h"

#include <vector>

namespace keyhole {

/// Whether light paths bring more where they begin as it was learned.
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

/// The shares that promise the least variance of visible power by part of the scene for the same work, light tracing
/// and chains alone among them; the setting `chain_share` leaves the rest to be found. Told by a few light paths and
/// chains, weighed anew for each. Work is measured in rays, so that shares are the same on every machine. @throws
/// Interrupted
WorkShares try_shares(const SamplerContext& context, const RunContext& run);

} // namespace keyhole
