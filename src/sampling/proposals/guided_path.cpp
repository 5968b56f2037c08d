// UI, user path, independent: a whole new path, whose light side follows a user path and which is joined to a new eye
// side at any of its edges. Its density is the sum over user paths and connections, so that contribution over density
// has no peaks where one connection's edge is short: unlike UP it leaves from, and comes to, such paths as readily as
// others.
#include "sampling/guidance/guided_paths.h"
#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

class GuidedPathProposal final : public Proposal<Path> {
  public:
    GuidedPathProposal(const ProposalContext& context, const UserPaths& paths)
        : scene_(*context.scene), guides_(*context.scene, paths, context.set, context.max_scatterings) {}

    std::string_view name() const override { return "user paths, independent"; }
    double suitability(const Path& /*x*/) const override { return 1; }

    std::optional<Path> propose(const Path& /*x*/, Rng& rng, Failure& why) const override {
        auto y = guides_.draw(rng, why);
        // What rounding carried out of cones or openings can't be proposed, if it can't be found again.
        if (y && y->target > 0 && !(guides_.draw_density(*y) > 0)) return why = Failure::signature, std::nullopt;
        return y;
    }
    double transition_density(const Path& x, const Path& y) const override {
        return is_all_new(scene_, x, y) ? guides_.draw_density(y) : 0.0;
    }

  private:
    const Scene& scene_;
    GuidedPaths guides_;
};

} // namespace

constinit const ProposalKind proposals::guided_path{
    .weight = {"guided_path.weight", 0.3, 0, 1,
               "relative frequency of whole new paths along user paths, where there are any"},
    .needs_user_paths = true,
    .family = kNewSubPaths,
    .make = [](const ProposalContext& context) {
        return only(std::make_unique<GuidedPathProposal>(context, context.user_paths()));
    }};

} // namespace keyhole
