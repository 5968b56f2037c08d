// UP, user path: a path built from the light along one that a person gave, joined to what the current path has from
// some vertex to the eye; or to a new eye, if it sees the end of the user path. Fan, Chenney, Lai 2005, section 5.1,
// join it to d1 alone: then only paths of one length find back.
//
// A fixed x0 would be a point mass against the other proposals' densities: it lies in a patch of the emitter. The way
// back is rarely a user path's: mixtures judge UP together with BD.
#include "sampling/guidance/guided_subpath.h"
#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"

#include <algorithm>
#include <cstdlib>

namespace keyhole {
namespace {

class UserPathProposal final : public Proposal<Path> {
  public:
    UserPathProposal(const ProposalContext& context, const UserPath& path)
        : scene_(*context.scene), set_(context.set), max_vertices_(context.max_scatterings + 2),
          guide_(*context.scene, path), label_("user path: " + path.name) {}

    std::string_view name() const override { return label_; }
    /// Whether total_weight() is more than nothing.
    double suitability(const Path& x) const override {
        const auto stays = [](const Vertex& v) { return !v.specular(); };
        return guide_.user_path().seen || std::any_of(x.x.begin() + 1, x.x.end() - 1, stays) ? 1 : 0;
    }
    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override;
    double transition_density(const Path& x, const Path& y) const override;

  private:
    /// Relative frequency of joining x[m], and with m = x.vertices() a new eye. Most often about as many vertices are
    /// replaced as are traced, so that the length of the path stays.
    double join_weight(const Path& x, int m) const {
        const bool new_eye = m == x.vertices();
        if (new_eye ? !guide_.user_path().seen : x.x[m].specular()) return 0;
        return 1.0 / (1 + std::abs((new_eye ? m - 1 : m) - guide_.vertices()));
    }
    template <class Visit> void for_each_join(const Path& x, Visit&& visit) const {
        for (int m = 1; m <= x.vertices(); ++m)
            if (m != x.vertices() - 1) visit(m, join_weight(x, m)); // the eye never stays alone
    }
    double total_weight(const Path& x) const {
        double total = 0;
        for_each_join(x, [&](int, double w) { total += w; });
        return total;
    }
    /// Index of the first vertex that stays, or x.vertices(). Something must suit x.
    int choose_join(const Path& x, Rng& rng) const {
        double left = rng.next() * total_weight(x);
        int chosen = 0;
        for_each_join(x, [&](int m, double w) {
            if (w == 0 || (chosen > 0 && left < 0)) return;
            chosen = m;
            left -= w;
        });
        return chosen;
    }

    const Scene& scene_;
    PathSet set_;
    int max_vertices_;
    GuidedSubPath guide_;
    std::string label_;
};

std::optional<Path> UserPathProposal::propose(const Path& x, Rng& rng, Failure& why) const {
    const int kept = choose_join(x, rng);
    const bool new_eye = kept == x.vertices();
    SubPath light, eye;
    if (new_eye) eye.push_back(sample_eye(scene_, rng));
    for (int i = x.vertices() - 1; i >= kept; --i) eye.push_back(x.x[i]);
    if (guide_.vertices() + static_cast<int>(eye.size()) > max_vertices_) return why = Failure::length, std::nullopt;
    if (!guide_.trace(light, rng, why)) return std::nullopt;
    auto y = join(scene_, set_, light, eye, x.image, why);
    // What rounding carried out of the cones can't be proposed, if it can't be found again.
    if (y && y->target > 0 && !(guide_.density(*y) > 0)) return why = Failure::signature, std::nullopt;
    return y;
}

double UserPathProposal::transition_density(const Path& x, const Path& y) const {
    const int n = x.vertices(), kept = y.vertices() - guide_.vertices(); // on y's side of the eye
    if (kept < 1 || kept > n - 1 || guide_.user_path().patch.pdf(y.x[0].point) == 0) return 0;
    const bool new_eye = kept == 1;
    const int join = new_eye ? n : n - kept;
    const double weight = join_weight(x, join);
    if (weight == 0 || !(cut_between(scene_, x, y) == Cut{-1, join})) return 0;
    const double side = weight / total_weight(x) * (new_eye ? y.x[y.x.size() - 1].pdf_from_eye : 1.0);
    return side * guide_.density(y);
}

} // namespace

constinit const ProposalKind proposals::user_path{
    .weight = {"user_path.weight", 0.05, 0, 1, "relative frequency of proposals along user paths, where there are any"},
    .needs_user_paths = true,
    .family = kNewSubPaths,
    .make = [](const ProposalContext& context) {
        ProposalList list;
        double total = 0;
        for (const UserPath& path : context.user_paths()) total += path.weight;
        for (const UserPath& path : context.user_paths())
            list.push_back({std::make_unique<UserPathProposal>(context, path), path.weight / total});
        return list;
    }};

} // namespace keyhole
