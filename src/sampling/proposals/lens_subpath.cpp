// LS, lens sub-path: a new image point and a new eye sub-path, traced through specular vertices to the first that is
// not, joined to the kept light sub-path (Veach 1997, section 11.3.3).
#include "sampling/paths/random_walk.h"
#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

class LensSubpath final : public Proposal<Path> {
  public:
    explicit LensSubpath(const ProposalContext& context)
        : scene_(*context.scene), set_(context.set), max_vertices_(context.max_scatterings + 2) {}

    std::string_view name() const override { return "lens_subpath"; }
    double suitability(const Path& x) const override { return lens_subpath_start(x) > 0 ? 1 : 0; }
    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override;
    double transition_density(const Path& x, const Path& y) const override;

  private:
    /// Traces from the eye to a non-specular vertex; at most `room` vertices, the eye included.
    bool trace_eye(SubPath& eye, const Vec2& image, int room, Rng& rng, Failure& why) const;

    const Scene& scene_;
    PathSet set_;
    int max_vertices_;
};

/// A walk through specular vertices to the first that is not.
struct LensWalk : WalkHooks {
    SubPath& eye;
    const std::size_t room;                       // vertices that there may be
    std::optional<Failure> why = Failure::length; // none: the walk has got there

    Vertex& place() const { return eye.emplace_back(); }
    void lost() { why = Failure::no_hit; }
    bool arrive(const Vertex& v, const WalkRay& /*ray*/) { return v.bsdf.traits().delta || end(); }
    // Having chosen a finite event it ends there, whether or not that would have led anywhere.
    void absorbed(const Vertex& v) {
        why = Failure::absorbed;
        if (v.bsdf.traits().finite) end();
    }
    bool leave(const Vertex& v, const Continuation& /*next*/, const WalkRay& /*ray*/) {
        return v.specular() ? eye.size() < room : end();
    }

  private:
    bool end() {
        why.reset();
        return false;
    }
};

bool LensSubpath::trace_eye(SubPath& eye, const Vec2& image, int room, Rng& rng, Failure& why) const {
    sample_eye(scene_, rng, eye.emplace_back());
    LensWalk walk{{}, eye, static_cast<std::size_t>(room)};
    random_walk(scene_, From::eye, eye_ray(scene_, eye[0].point, image), room, rng, walk);
    if (walk.why) why = *walk.why;
    return !walk.why;
}

std::optional<Path> LensSubpath::propose(const Path& x, Rng& rng, Failure& why) const {
    const int d1 = lens_subpath_start(x);
    SubPath light, eye;
    for (int i = 0; i < d1; ++i) light.push_back(x.x[i]);
    const auto [u, v] = rng.next_point();
    const Vec2 image(static_cast<float>(u), static_cast<float>(v));
    if (!trace_eye(eye, image, max_vertices_ - d1, rng, why)) return std::nullopt;
    return join(scene_, set_, light, eye, image, why);
}

double LensSubpath::transition_density(const Path& x, const Path& y) const {
    const int d1 = lens_subpath_start(y);
    if (d1 == 0 || d1 != lens_subpath_start(x)) return 0;
    double density = 1;
    for (int i = d1; i < y.vertices(); ++i) density *= y.x[i].pdf_from_eye;
    // At d1 the walk also had to choose to stop.
    const Vertex& last = y.x[d1];
    return density * finite_probability(last, direction(last.point, y.x[d1 + 1].point));
}

} // namespace

constinit const ProposalKind proposals::lens_subpath{
    .weight = {"lens_subpath.weight", 0.1, 0, 1, "relative frequency of lens sub-path proposals"},
    .make = [](const ProposalContext& context) { return only(std::make_unique<LensSubpath>(context)); }};

} // namespace keyhole
