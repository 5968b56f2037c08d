// Probabilities of the kinds of proposal, from what each brings.
#pragma once

#include "sampling/proposals/registry.h"

namespace keyhole {

/// `settings` with the weights of its kinds of proposal, which sum to one, half of them shared out by how
/// far a candidate of each kind moves a chain for the rays that it takes: the expected squared jump (Pasarica and
/// Gelman 2010) in the image, that of the vertex which light meets first, and the product of the two, each relative to
/// all kinds. Those of probability 0 stay out. It is measured at `paths`, drawn from the target: chains that are to be
/// told by it should start elsewhere. Takes a sixteenth of `mutations` at most. Where these are too few to tell, there
/// are no paths, or `tune_proposals` is off, the settings stay as they are.
Settings tuned_proposals(const ProposalContext& context, const Settings& settings, std::span<const Path> paths,
                         std::uint64_t seed);

} // namespace keyhole
