// Light sub-paths along all user paths of a scene, chosen by their weights.
#pragma once

#include "sampling/guided_subpath.h"

#include <vector>

namespace keyhole {

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
