// What it would bring light paths to be led.
#pragma once

#include "sampling/guidance/found/passages.h"
#include "sampling/guidance/guided_subpath.h"
#include "sampling/guidance/learned/learned_emission.h"

namespace keyhole {

/// By how much fewer light paths do as well if half of them are led by `guides`: the second moment of the power that
/// free paths bring to a place, over that of the mixture, in the geometric mean over the places that matter to the eye,
/// which `eye` tells in coarse cells. (The arithmetic one would be that of the few cells to which one path came.) Both
/// are estimated from the mixture, whose densities are known, so that what free paths hardly ever find counts in full,
/// up to the number of free paths that were traced: what is rarer can't be told from what isn't led at all.
/// Free paths, those of the mixture too, begin as `learned` says; null: by power. 1 where no light arrives. The same on
/// any number of threads.
/// @throws Interrupted
double gain_by_guides(const Scene& scene, const LightGuides& guides, const std::vector<TransportEnd>& eye,
                      std::uint64_t seed, const RunContext& context, const LearnedEmission* learned = nullptr);

} // namespace keyhole
