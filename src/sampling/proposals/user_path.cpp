// UP, user path: a path built from the light along one that a person gave, to which the eye's side of the current path
// is joined, from d1 on (Fan, Chenney, Lai 2005, section 5.1); or a new eye, if it sees the end of the user path.
//
// Each direction lies in a cone about the one from the new vertex to the user's next point; specular vertices follow
// the user path's events. x0 lies in a patch of the emitter around the user's: a fixed x0 would be a point mass against
// the other proposals' densities. The way back is rarely a user path's: mixtures judge UP together with BD.
#include "sampling/proposals/cut.h"
#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"
#include "sampling/proposals/steps.h"

namespace keyhole {
namespace {

class UserPathProposal final : public Proposal<Path> {
  public:
    UserPathProposal(const ProposalContext& context, const UserPath& path)
        : scene_(*context.scene), set_(context.set), max_vertices_(context.max_scatterings + 2), path_(path),
          label_("user path: " + path.name) {
        events_.x.push_back({});
        for (const UserVertex& v : path.vertices) {
            events_.x.push_back({});
            events_.x.back().event = v.event;
        }
    }

    std::string_view name() const override { return label_; }
    double suitability(const Path& x) const override { return path_.seen || nth_finite_from_eye(x, 1) > 0 ? 1 : 0; }
    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override;
    double transition_density(const Path& x, const Path& y) const override;

  private:
    /// Probability of joining a new eye rather than d1.
    double eye_probability(const Path& x) const {
        if (!path_.seen) return 0;
        return nth_finite_from_eye(x, 1) > 0 ? 0.5 : 1;
    }
    /// Unit direction from a vertex towards user vertex i.
    Vec3 axis(const Vertex& from, int i) const {
        return (path_.vertices[static_cast<std::size_t>(i) - 1].p - from.point.p).normalized();
    }
    Cone cone(int i) const { return Cone(path_.vertices[static_cast<std::size_t>(i) - 1].beta); }

    /// Traces a sub-path from the light along the user path.
    bool trace(SubPath& light, Rng& rng, Failure& why) const;
    /// Density with which trace() makes the first vertices of y.
    double light_density(const Path& y) const;

    const Scene& scene_;
    PathSet set_;
    int max_vertices_;
    UserPath path_;
    std::string label_;
    Path events_; ///< only the events of its vertices count; x0 and those of path_
};

bool UserPathProposal::trace(SubPath& light, Rng& rng, Failure& why) const {
    light.push_back(make_vertex(path_.patch.sample(rng)));
    const int last = events_.vertices() - 1;
    for (int i = 0; i < last;) {
        const int next = next_finite(events_, i, +1);
        const Vec3 w = cone(i + 1).sample(axis(light.back(), i + 1), rng);
        if (!retrace(scene_, light, light.back().point, w, events_, i + 1, next, why)) return false;
        i = next;
    }
    return true;
}

double UserPathProposal::light_density(const Path& y) const {
    double density = path_.patch.pdf(y.x[0].point);
    const int last = events_.vertices() - 1;
    for (int i = 1; i <= last && density > 0; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (y.x[k].event != events_.x[k].event) return 0;
    }
    for (int i = 0; i < last && density > 0;) {
        const int next = next_finite(events_, i, +1);
        const Vertex &from = y.x[static_cast<std::size_t>(i)], &to = y.x[static_cast<std::size_t>(i) + 1];
        const double w = cone(i + 1).density(axis(from, i + 1), leaving_direction(y, i, +1));
        density *= w > 0 ? retrace_density(y, solid_angle_to_area(w, from.point, to.point), i + 1, next) : 0.0;
        i = next;
    }
    return density;
}

std::optional<Path> UserPathProposal::propose(const Path& x, Rng& rng, Failure& why) const {
    const bool new_eye = rng.next() < eye_probability(x);
    SubPath light, eye;
    Vec2 image = x.image;
    if (new_eye) {
        eye.push_back(sample_eye(scene_, rng));
    } else {
        const int d1 = nth_finite_from_eye(x, 1);
        for (int i = x.vertices() - 1; i >= d1; --i) eye.push_back(x.x[static_cast<std::size_t>(i)]);
    }
    if (events_.vertices() + static_cast<int>(eye.size()) > max_vertices_) return why = Failure::length, std::nullopt;
    if (!trace(light, rng, why)) return std::nullopt;
    if (new_eye) {
        const auto p = scene_.camera().image_point(eye[0].point, direction(eye[0].point, light.back().point));
        if (!p) return why = Failure::outside_image, std::nullopt;
        image = *p;
    }
    auto y = join(scene_, set_, light, eye, image, why);
    // What rounding carried out of the cones can't be proposed, if it can't be found again.
    if (y && y->target > 0 && !(light_density(*y) > 0)) return why = Failure::signature, std::nullopt;
    return y;
}

double UserPathProposal::transition_density(const Path& x, const Path& y) const {
    const int d1 = nth_finite_from_eye(x, 1), n = x.vertices(), traced = events_.vertices();
    const int kept = y.vertices() - traced; // eye's side of y
    const bool new_eye = kept == 1;
    if (!new_eye && (d1 == 0 || kept != n - d1)) return 0;
    const double side = new_eye ? eye_probability(x) * y.x[y.x.size() - 1].pdf_from_eye : 1 - eye_probability(x);
    if (side == 0 || path_.patch.pdf(y.x[0].point) == 0) return 0;
    if (!(cut_between(scene_, x, y) == Cut{-1, new_eye ? n : d1})) return 0;
    return side * light_density(y);
}

} // namespace

PathProposal make_user_path(const ProposalContext& context, const UserPath& path) {
    return std::make_unique<UserPathProposal>(context, path);
}

} // namespace keyhole
