// Whether there is light to store at all, where a survey by eye paths met none.
#pragma once

#include "methods/photons/photon_sampler.h"

namespace keyhole {

/// Whether light paths come near anything that eye paths come near, walls between them or not, for light may pass
/// through a gap that no trial found; or whether any way of stage one joins the two. @throws Interrupted
bool may_be_lit(const SamplerContext& context, const RunContext& run);

} // namespace keyhole
