// How chains and light paths share the work of photon maps that both fill.
#pragma once

#include "methods/photons/photon_sampler.h"

namespace keyhole {

/// The shares that promise the least variance of visible power by part of the scene for the same work, light tracing
/// and chains alone among them; the setting `chain_share` leaves the rest to be found. Told by a few light paths and
/// chains, weighed anew for each. Work is measured in rays, so that shares are the same on every machine. @throws
/// Interrupted
WorkShares try_shares(const SamplerContext& context, const RunContext& run);

} // namespace keyhole
