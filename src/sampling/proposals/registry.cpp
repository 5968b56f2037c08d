#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

constexpr ProposalKind kKinds[] = {
    {make_bidirectional, &Settings::p_bidirectional},
    {make_lens_subpath, &Settings::p_lens_subpath},
    {make_lens_perturbation, &Settings::p_lens_perturbation},
    {make_multi_chain_perturbation, &Settings::p_multi_chain_perturbation, true},
    {make_caustic_perturbation, &Settings::p_caustic_perturbation, true},
    {make_photon_map_perturbation, &Settings::p_photon_map},
};

} // namespace

std::span<const ProposalKind> proposal_kinds() { return kKinds; }

Mixture<Path> make_mixture(const ProposalContext& context, const Settings& settings, const UserPaths& paths,
                           std::vector<double Settings::*>* weights) {
    constexpr int kFamily = 0; // of BD, UP and UI, which replace the same vertices
    Mixture<Path> mixture;
    const auto add = [&](PathProposal kind, double Settings::*weight, double share, int family) {
        if (weights != nullptr && settings.*weight * share > 0) weights->push_back(weight);
        mixture.add(std::move(kind), settings.*weight * share, family);
    };
    for (const ProposalKind& kind : kKinds)
        if (kind.wanted(*context.scene, settings))
            add(kind.make(context), kind.weight, 1, kind.make == make_bidirectional ? kFamily : Mixture<Path>::kAlone);
    double total = 0;
    for (const UserPath& path : paths) total += path.weight;
    for (const UserPath& path : paths)
        add(make_user_path(context, path), &Settings::p_user_path, path.weight / total, kFamily);
    if (!paths.empty()) add(make_guided_path(context, paths), &Settings::p_guided_path, 1, kFamily);
    return mixture;
}

} // namespace keyhole
