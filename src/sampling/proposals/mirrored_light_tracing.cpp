// LM, light tracing by way of mirrors: a whole new path, traced from the light and joined to the lens by way of flat
// mirrors. Nothing else goes straight to a caustic that is seen in a mirror: LT sees it directly only, and a chain that
// came to it from the eye, once in thousands of proposals, stays.
#include "sampling/proposals/mirrored_light_paths.h"
#include "sampling/proposals/new_path_proposal.h"

namespace keyhole {

constinit const ProposalKind proposals::mirrored_light_tracing{
    .weight = {"mirrored_light_tracing.weight", 0.1, 0, 1,
               "relative frequency of whole new paths traced from the light that the eye sees in flat mirrors"},
    .needs_specular = true,
    .family = kNewSubPaths,
    .make = [](const ProposalContext& context) {
        MirroredLightPaths paths(context);
        if (paths.empty()) return ProposalList();
        return only(std::make_unique<NewPathProposal<MirroredLightPaths>>("mirrored_light_tracing", *context.scene,
                                                                          std::move(paths)));
    }};

} // namespace keyhole
