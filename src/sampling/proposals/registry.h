// The kinds of proposal over paths. To add one: a file beside this one, its factory here, its line in registry.cpp.
#pragma once

#include "core/settings.h"
#include "sampling/mixture.h"
#include "sampling/path.h"
#include "sampling/user_paths.h"
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
PathProposal make_user_path(const ProposalContext& context, const UserPath& path);
PathProposal make_guided_path(const ProposalContext& context, const UserPaths& paths);

/// One line of the table.
struct ProposalKind {
    PathProposal (*make)(const ProposalContext&);
    double Settings::*weight;
    bool needs_specular = false; ///< nothing to do in scenes without mirrors and smooth glass

    /// Whether the mixture for this scene and these settings has it.
    bool wanted(const Scene& scene, const Settings& settings) const {
        return !needs_specular || scene.traits().delta || settings.plan == "all";
    }
};

/// All kinds but user paths, which a scene has its own of. Statistics, settings and tests read this table.
std::span<const ProposalKind> proposal_kinds();

/// The mixture that `settings` ask for. Each of `paths` is a kind of its own, and they share p_user_path by their
/// weights; together with BD and UI, which draws from all of them, they are one family.
/// @param weights gets, where it is not null, the setting of each kind of the mixture.
Mixture<Path> make_mixture(const ProposalContext& context, const Settings& settings, const UserPaths& paths = {},
                           std::vector<double Settings::*>* weights = nullptr);

/// Mixtures for a set of chains.
struct ChainMixtures {
    Mixture<Path> mixture;
    std::optional<Mixture<Path>> control; ///< the same without user paths, where there are any

    ChainMixtures(const ProposalContext& context, const Settings& settings, const UserPaths& paths)
        : mixture(make_mixture(context, settings, paths)) {
        if (!paths.empty() && settings.p_user_path + settings.p_guided_path > 0)
            control = make_mixture(context, settings);
    }
    const Mixture<Path>* control_or_null() const { return control ? &*control : nullptr; }
};

} // namespace keyhole
