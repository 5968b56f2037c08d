// The kinds of proposal over paths. To add one: a file beside this one, its factory here, its line in registry.cpp.
#pragma once

#include "core/settings.h"
#include "sampling/mixture.h"
#include "sampling/path.h"
#include "scene/scene.h"

#include <span>

namespace keyhole {

/// What proposals know besides the path. The scene must outlive them.
struct ProposalContext {
    const Scene* scene;
    PathSet set = PathSet::stored;
    int max_scatterings = kMaxScatterings;
};

using PathProposal = std::unique_ptr<const Proposal<Path>>;

PathProposal make_bidirectional(const ProposalContext& context);
PathProposal make_lens_subpath(const ProposalContext& context);
PathProposal make_lens_perturbation(const ProposalContext& context);
PathProposal make_multi_chain_perturbation(const ProposalContext& context);
PathProposal make_caustic_perturbation(const ProposalContext& context);
PathProposal make_photon_map_perturbation(const ProposalContext& context);

/// One line of the table.
struct ProposalKind {
    PathProposal (*make)(const ProposalContext&);
    double Settings::*weight;
};

/// All kinds. Statistics, settings and tests read this table.
std::span<const ProposalKind> proposal_kinds();

/// The mixture that `settings` ask for.
Mixture<Path> make_mixture(const ProposalContext& context, const Settings& settings);

} // namespace keyhole
