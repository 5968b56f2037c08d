// Independent paths along user paths: what stage one adds to its own technique where there are some, so that B_eye and
// the seeds of the chains don't wait for chance to find the passage that a person has shown.
#pragma once

#include "sampling/guidance/guided_subpath.h"

#include <functional>

namespace keyhole {

/// Joins every vertex of a sub-path from the light, from the end of a user path on, to every one of a sub-path from the
/// eye, and shares what it finds with another technique by the balance heuristic (Veach 1997, section 9.2.2): one
/// sample of either.
class GuidedPaths {
  public:
    /// `set`: the paths to be found, of at most `max_scatterings`. The scene and the set's gather coverage must
    /// outlive it.
    GuidedPaths(const Scene& scene, const UserPaths& paths, PathSet set, int max_scatterings);

    /// Number density of the measured path y among those of sample(), by all user paths together, in the convention of
    /// measure.h.
    double density(const Path& y) const;

    /// One sample: some pairs of a sub-path along one of the user paths and one from the eye through window point
    /// `image`. Every join of a pair that carries light is passed to `found`, measured; the number density of these
    /// paths is density().
    void sample(const Vec2& image, Rng& rng, const std::function<void(const Path&)>& found) const;

    /// A single path: sub-paths of lengths that are drawn beforehand, joined at their ends. None where they carry no
    /// light, for the reason in `why`.
    std::optional<Path> draw(Rng& rng, Failure& why) const;
    /// Density with which draw() makes y, in the convention of measure.h.
    double draw_density(const Path& y) const;

  private:
    void sample_pair(const Vec2& image, Rng& rng, const std::function<void(const Path&)>& found) const;
    /// Number density of y among the connections of a pair.
    double expected_connections(const Path& y) const;

    const Scene* scene_;
    PathSet set_;
    int max_scatterings_;
    LightGuides guides_;
};

} // namespace keyhole
