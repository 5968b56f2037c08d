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

Mixture<Path> make_mixture(const ProposalContext& context, const Settings& settings, const UserPaths& paths) {
    constexpr int kFamily = 0; // of BD, UP and UI, which replace the same vertices
    Mixture<Path> mixture;
    for (const ProposalKind& kind : kKinds)
        if (kind.wanted(*context.scene, settings))
            mixture.add(kind.make(context), settings.*kind.weight,
                        kind.make == make_bidirectional ? kFamily : Mixture<Path>::kAlone);
    double total = 0;
    for (const UserPath& path : paths) total += path.weight;
    for (const UserPath& path : paths)
        mixture.add(make_user_path(context, path), settings.p_user_path * path.weight / total, kFamily);
    if (!paths.empty()) mixture.add(make_guided_path(context, paths), settings.p_guided_path, kFamily);
    return mixture;
}

} // namespace keyhole
