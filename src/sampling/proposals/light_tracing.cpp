// LT, light tracing: a whole new path, traced from the light and joined to the lens. To what light tracing finds
// easily, such as caustics by mirrors, other kinds move a chain in small steps or next to never: a specular vertex
// leaves nothing to join, and BD traces a path from one end to the other once in hundreds of proposals.
#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

/// Probability that the walk ends at a vertex where it may.
constexpr double kEnd = 0.5;
/// Light alone says what is drawn; where it meets the lens follows.
const Vec2 kNoImage(0, 0);

class LightTracing final : public Proposal<Path> {
  public:
    explicit LightTracing(const ProposalContext& context)
        : scene_(*context.scene), set_(context.set), most_(context.max_scatterings + 1) {}

    std::string_view name() const override { return "light_tracing"; }
    double suitability(const Path& /*x*/) const override { return 1; }
    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override;
    double transition_density(const Path& x, const Path& y) const override;

  private:
    /// Whether the walk may end at vertex i of a path, or of a light sub-path: not where what comes straight from the
    /// emitter makes a path outside the set, nor where nothing can be joined.
    bool may_end(const SubPath& x, int i) const {
        if (i < 1 || !x[i].bsdf.traits().finite) return false;
        return set_.everything || i > 2 || (i == 2 && x[1].specular());
    }
    bool trace(SubPath& light, Rng& rng, Failure& why) const;

    const Scene& scene_;
    PathSet set_;
    int most_; ///< vertices of a light sub-path
};

bool LightTracing::trace(SubPath& light, Rng& rng, Failure& why) const {
    const auto x0 = sample_emitter(scene_, rng);
    if (!x0) return why = Failure::no_light, false;
    light.push_back(x0->vertex);
    while (static_cast<int>(light.size()) < most_) {
        if (!grow(scene_, light, From::light, kNoImage, false, rng, why)) return false;
        if (may_end(light, static_cast<int>(light.size()) - 1) && rng.next() < kEnd) return true;
    }
    return why = Failure::length, false;
}

std::optional<Path> LightTracing::propose(const Path& /*x*/, Rng& rng, Failure& why) const {
    SubPath light, eye;
    if (!trace(light, rng, why)) return std::nullopt;
    light.back().event = Event::finite;
    eye.push_back(sample_eye(scene_, rng));
    return join(scene_, set_, light, eye, kNoImage, why);
}

double LightTracing::transition_density(const Path& x, const Path& y) const {
    if (!is_all_new(scene_, x, y)) return 0;
    const int last = y.vertices() - 2;
    if (!may_end(y.x, last) || y.x[last].specular()) return 0;
    double density = kEnd * y.x[last].pdf_from_light * y.x[last + 1].pdf_from_eye;
    for (int i = 0; i < last; ++i) density *= y.x[i].pdf_from_light * (may_end(y.x, i) ? 1 - kEnd : 1);
    return density;
}

} // namespace

constinit const ProposalKind proposals::light_tracing{
    .weight = {"light_tracing.weight", 0.1, 0, 1, "relative frequency of whole new paths traced from the light"},
    .family = kNewSubPaths,
    .make = [](const ProposalContext& context) { return only(std::make_unique<LightTracing>(context)); }};

} // namespace keyhole
