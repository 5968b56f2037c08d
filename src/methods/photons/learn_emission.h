// Where light paths begin, learned once for all passes: whoever makes one of them makes the same photons.
#pragma once

#include "methods/photons/photon_sampler.h"
#include "sampling/guidance/learned_emission.h"

#include <optional>

namespace keyhole {

/// From so many paths. None where it doesn't pay.
std::optional<LearnedEmission> learn_emission(const SamplerContext& context, std::int64_t paths, const RunContext& run);
/// From as many as a pass deserves, with a clock of its own.
std::optional<LearnedEmission> learn_emission(const SamplerContext& context, RenderStats& stats, const RunContext& run);

} // namespace keyhole
