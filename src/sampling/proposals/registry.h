// The kinds of proposal over paths: each has a file beside this one, and a line in kinds.inc.
#pragma once

#include "core/settings.h"
#include "sampling/guidance/user_paths.h"
#include "sampling/markov/mixture.h"
#include "sampling/paths/path_set.h"
#include "scene/scene.h"

#include <span>

namespace keyhole {

/// What proposals know besides the path. The scene must outlive them.
struct ProposalContext {
    const Scene* scene;
    PathSet set = PathSet::stored;
    int max_scatterings = kMaxScatterings;
    const UserPaths* guides = nullptr; ///< null: no user paths

    const UserPaths& user_paths() const {
        static const UserPaths none;
        return guides != nullptr ? *guides : none;
    }
};

using PathProposal = std::unique_ptr<const Proposal<Path>>;

/// A proposal, and the share that it has of the weight of its kind.
struct WeightedProposal {
    PathProposal proposal;
    double share = 1;
};
using ProposalList = std::vector<WeightedProposal>;
ProposalList only(PathProposal proposal);

/// Those that replace the same vertices, BD, UP and UI, are one family.
constexpr int kNewSubPaths = 0;

/// What the file of a proposal says of it.
struct ProposalKind {
    ProposalParameter weight;      ///< relative frequency
    bool needs_specular = false;   ///< nothing to do in scenes without mirrors and smooth glass
    bool needs_user_paths = false; ///< nothing to do without any
    int family = Mixture<Path>::kAlone;
    ProposalList (*make)(const ProposalContext&); ///< one, or one for each user path
};

namespace proposals {
#define KEYHOLE_PROPOSAL(name) extern const ProposalKind name;
#include "sampling/proposals/kinds.inc"
#undef KEYHOLE_PROPOSAL
} // namespace proposals

/// All kinds. Statistics, settings and tests read this table.
std::span<const ProposalKind* const> proposal_kinds();

/// The mixture that `settings` ask for.
/// @param kinds gets, where it is not null, the kind of each proposal of the mixture.
Mixture<Path> make_mixture(const ProposalContext& context, const Settings& settings,
                           std::vector<const ProposalKind*>* kinds = nullptr);

/// Mixtures for a set of chains.
struct ChainMixtures {
    Mixture<Path> mixture;
    std::optional<Mixture<Path>> control; ///< the same without user paths, where there are any

    ChainMixtures(const ProposalContext& context, const Settings& settings);
    const Mixture<Path>* control_or_null() const { return control ? &*control : nullptr; }
};

} // namespace keyhole
