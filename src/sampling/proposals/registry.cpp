#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

#define KEYHOLE_PROPOSAL(name) &proposals::name,
constexpr const ProposalKind* kKinds[] = {
#include "sampling/proposals/kinds.inc"
};
#undef KEYHOLE_PROPOSAL

#define KEYHOLE_PROPOSAL(name) &proposals::name.weight,
constexpr const ProposalParameter* kParameters[] = {
#include "sampling/proposals/kinds.inc"
};
#undef KEYHOLE_PROPOSAL

} // namespace

std::span<const ProposalKind* const> proposal_kinds() { return kKinds; }
std::span<const ProposalParameter* const> proposal_parameters() { return kParameters; }

ProposalList only(PathProposal proposal) {
    ProposalList list;
    list.push_back({std::move(proposal)});
    return list;
}

Mixture<Path> make_mixture(const ProposalContext& context, const Settings& settings,
                           std::vector<const ProposalKind*>* kinds) {
    Mixture<Path> mixture;
    for (const ProposalKind* kind : kKinds) {
        if (kind->needs_specular && !context.scene->traits().delta && settings.plan != Plan::all) continue;
        if (kind->needs_user_paths && context.user_paths().empty()) continue;
        for (auto& [proposal, share] : kind->make(context))
            mixture.add(std::move(proposal), settings.proposals[kind->weight] * share, kind->family);
        if (kinds != nullptr) kinds->resize(mixture.size(), kind);
    }
    return mixture;
}

ChainMixtures::ChainMixtures(const ProposalContext& context, const Settings& settings)
    : mixture(make_mixture(context, settings)) {
    if (context.user_paths().empty()) return;
    ProposalContext unguided = context;
    unguided.guides = nullptr;
    Mixture<Path> without = make_mixture(unguided, settings);
    if (without.size() < mixture.size()) control = std::move(without);
}

} // namespace keyhole
