// The light's side of a path, traced along one that a person gave: what user-path proposals begin with, and stage one's
// independent paths where there are user paths.
#pragma once

#include "sampling/guidance/user_paths.h"
#include "sampling/proposals/edit.h"

#include <vector>

namespace keyhole {

/// Sub-paths from the light along a user path. Each direction lies in a cone about the one from the new vertex to the
/// user's next point, or leads through a portal, or is that of light which is emitted or scattered; specular vertices
/// follow the user path's events. x0 lies in a patch of the emitter around the user's. The scene must outlive it.
///
/// BSDF sampling seldom lands where the portal subtends a large solid angle, and light from there carries much more
/// than the rest. So half of the sub-paths whose portal is behind a bounce cross it along lines that are drawn there,
/// and are joined to the vertex before. In a corner beside a door that vertex is near as well, and so on: where there
/// are more bounces, light is followed back by up to three of them before it is joined.
class GuidedSubPath {
  public:
    GuidedSubPath(const Scene& scene, const UserPath& path);

    const UserPath& user_path() const { return path_; }
    /// Vertices of every sub-path, that on the light included.
    int vertices() const { return events_.vertices(); }
    /// Traces one into `light`. False where light doesn't get along, for the reason in `why`.
    bool trace(SubPath& light, Rng& rng, Failure& why) const;
    /// Density with which trace() makes the first vertices of y, in the convention of measure.h.
    double density(const Path& y) const;

  private:
    const UserVertex& user_vertex(int i) const { return path_.vertices[static_cast<std::size_t>(i) - 1]; }
    /// Probability that light is followed back from the portal by so many bounces; -1: it comes there from the light.
    double probability_of_back(int back) const;
    /// Adds the two vertices of a line through the portal, and before them those that it is followed back to.
    bool cross(SubPath& light, int back, Rng& rng, Failure& why) const;
    /// Of these vertices, per area each.
    double cross_density(const Path& y, int back) const;
    /// False where vertex i ought to lie beyond a portal and does not.
    bool through_portal(const Vertex& from, const Vertex& to, int i) const;
    bool bounce(SubPath& light, Rng& rng, Failure& why) const;
    Vec3 sample_direction(const Vertex& from, int i, Rng& rng) const;
    double direction_density(const Vertex& from, const Vec3& w, int i) const;

    const Scene* scene_;
    UserPath path_;
    int crossed_ = 0;    ///< the vertex behind a portal that is behind a bounce, where there is one
    int most_back_ = -1; ///< bounces that light is followed back from there at most; -1: there is no such vertex
    Path events_;        ///< only the events of its vertices count; x0 and those of path_
};

class LightGuides {
  public:
    LightGuides() = default;
    /// The scene must outlive them.
    LightGuides(const Scene& scene, const UserPaths& paths) {
        double total = 0;
        for (const UserPath& path : paths) total += path.weight;
        for (const UserPath& path : paths) guides_.push_back({GuidedSubPath(scene, path), path.weight / total});
    }

    bool empty() const { return guides_.empty(); }
    /// There must be one.
    const GuidedSubPath& choose(Rng& rng) const {
        double left = rng.next();
        for (const Guide& guide : guides_)
            if ((left -= guide.probability) < 0) return guide.subpath;
        return guides_.back().subpath;
    }
    /// Calls visit(sub-path, probability) for each.
    template <class Visit> void for_each(Visit&& visit) const {
        for (const Guide& guide : guides_) visit(guide.subpath, guide.probability);
    }

  private:
    struct Guide {
        GuidedSubPath subpath;
        double probability;
    };
    std::vector<Guide> guides_;
};

} // namespace keyhole
