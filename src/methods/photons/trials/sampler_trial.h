// Which sampler suits a scene, by trial.
#pragma once

#include "methods/method.h"
#include "methods/photons/photon_sampler.h"

namespace keyhole {

/// What a trial says about a sampler: the variance of the share of visible power that falls in each part of the scene,
/// summed over the parts, times work. Half of it needs half the time for the same error.
struct SamplerTrial {
    double emission;   ///< ipm
    double metropolis; ///< mps, brightness included; infinite where stage one found nothing

    /// Chains of a trial are too short to show what they never reach: only where they promise so many times more are
    /// they believed.
    static constexpr double kDoubt = 2;

    /// The method that `settings.method` = auto stands for.
    const Method& best() const { return kDoubt * metropolis < emission ? methods::mps : methods::ipm; }
};

/// Tries both on a little of everything: light paths, samples of stage one, steps of chains from its seeds (their
/// autocorrelation counts, since chains are compared as wholes). Work is measured in rays and not in seconds, so that
/// the choice is the same on every machine and at every load.
SamplerTrial try_samplers(const SamplerContext& context, const RunContext& run);

/// Whether light paths come near anything that eye paths come near, walls between them or not: light may pass through a
/// gap that no trial found.
bool may_be_lit(const SamplerContext& context, const RunContext& run);

} // namespace keyhole
