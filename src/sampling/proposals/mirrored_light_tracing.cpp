// LM, light tracing by way of mirrors: a whole new path, traced from the light and joined to the lens by way of flat
// mirrors. Nothing else goes straight to a caustic that is seen in a mirror: LT sees it directly only, and a chain that
// came to it from the eye, once in thousands of proposals, stays.
#include "sampling/proposals/mirrored_light_paths.h"

namespace keyhole {
namespace {

class MirroredLightTracing final : public Proposal<Path> {
  public:
    MirroredLightTracing(const Scene& scene, MirroredLightPaths paths) : scene_(scene), paths_(std::move(paths)) {}

    std::string_view name() const override { return "mirrored_light_tracing"; }
    double suitability(const Path& /*x*/) const override { return 1; }
    std::optional<Path> propose(const Path& /*x*/, Rng& rng, Failure& why) const override {
        return paths_.sample(rng, why);
    }
    double transition_density(const Path& x, const Path& y) const override {
        return is_all_new(scene_, x, y) ? paths_.density(y) : 0;
    }

  private:
    const Scene& scene_;
    MirroredLightPaths paths_;
};

} // namespace

constinit const ProposalKind proposals::mirrored_light_tracing{
    .weight = {"mirrored_light_tracing.weight", 0.1, 0, 1,
               "relative frequency of whole new paths traced from the light that the eye sees in flat mirrors"},
    .needs_specular = true,
    .family = kNewSubPaths,
    .make = [](const ProposalContext& context) {
        MirroredLightPaths paths(context);
        return paths.empty() ? ProposalList()
                             : only(std::make_unique<MirroredLightTracing>(*context.scene, std::move(paths)));
    }};

} // namespace keyhole
