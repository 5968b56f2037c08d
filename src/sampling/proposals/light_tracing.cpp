// LT, light tracing: a whole new path, traced from the light and joined to the lens. To what light tracing finds
// easily, such as caustics by mirrors, other kinds move a chain in small steps or next to never: a specular vertex
// leaves nothing to join, and BD traces a path from one end to the other once in hundreds of proposals.
#include "sampling/proposals/light_walk.h"
#include "sampling/proposals/new_path_proposal.h"

namespace keyhole {
namespace {

class LightPaths {
  public:
    explicit LightPaths(const ProposalContext& context) : scene_(*context.scene), set_(context.set), walk_(context) {}

    std::optional<Path> draw(Rng& rng, Failure& why) const {
        SubPath light, eye;
        if (!walk_.trace(light, rng, why)) return std::nullopt;
        eye.push_back(sample_eye(scene_, rng));
        return join(scene_, set_, light, eye, kNoImage, why);
    }
    double draw_density(const Path& y) const {
        const int last = y.vertices() - 2;
        return walk_.density(y, last) * y.x[last + 1].pdf_from_eye;
    }

  private:
    const Scene& scene_;
    PathSet set_;
    LightWalk walk_;
};

} // namespace

constinit const ProposalKind proposals::light_tracing{
    .weight = {"light_tracing.weight", 0.1, 0, 1, "relative frequency of whole new paths traced from the light"},
    .family = kNewSubPaths,
    .make = [](const ProposalContext& context) {
        return only(
            std::make_unique<NewPathProposal<LightPaths>>("light_tracing", *context.scene, LightPaths(context)));
    }};

} // namespace keyhole
