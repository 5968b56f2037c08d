// UI, user path, independent: a whole new path, whose light side follows a user path and which is joined to a new eye
// side at any of its edges. Its density is the sum over user paths and connections, so that contribution over density
// has no peaks where one connection's edge is short: unlike UP it leaves from, and comes to, such paths as readily as
// others.
#include "sampling/guidance/guided_paths.h"
#include "sampling/proposals/new_path_proposal.h"
#include "sampling/proposals/registry.h"

namespace keyhole {

constinit const ProposalKind proposals::guided_path{
    .weight = {"guided_path.weight", 0.3, 0, 1,
               "relative frequency of whole new paths along user paths, where there are any"},
    .needs_user_paths = true,
    .family = kNewSubPaths,
    .make = [](const ProposalContext& context) {
        return only(std::make_unique<NewPathProposal<GuidedPaths>>(
            "user paths, independent", *context.scene,
            GuidedPaths(*context.scene, context.user_paths(), context.set, context.max_scatterings)));
    }};

} // namespace keyhole
