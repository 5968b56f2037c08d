// Walks from the light to where they are joined to the lens: what the proposals share that trace whole new paths from
// the light. A walk may end at any D, and ends there or goes on by even chances.
#pragma once

#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"

namespace keyhole {

/// Light alone says what is drawn; where it meets the lens follows.
inline const Vec2 kNoImage(0, 0);

class LightWalk {
  public:
    explicit LightWalk(const ProposalContext& context)
        : scene_(*context.scene), set_(context.set), most_(context.max_scatterings + 1) {}

    /// Traces a light sub-path to a vertex that may be joined to the lens.
    bool trace(SubPath& light, Rng& rng, Failure& why) const {
        const auto x0 = sample_emitter(scene_, rng);
        if (!x0) return why = Failure::no_light, false;
        light.push_back(x0->vertex);
        while (static_cast<int>(light.size()) < most_) {
            if (!grow(scene_, light, From::light, kNoImage, false, rng, why)) return false;
            if (may_end(light, static_cast<int>(light.size()) - 1) && rng.next() < kEnd) {
                light.back().event = Event::finite;
                return true;
            }
        }
        return why = Failure::length, false;
    }

    /// Density with which trace() makes y[0], ..., y[last].
    double density(const Path& y, int last) const {
        if (!may_end(y.x, last) || y.x[last].specular()) return 0;
        double density = kEnd * y.x[last].pdf_from_light;
        for (int i = 0; i < last; ++i) density *= y.x[i].pdf_from_light * (may_end(y.x, i) ? 1 - kEnd : 1);
        return density;
    }

  private:
    /// Probability that the walk ends at a vertex where it may.
    static constexpr double kEnd = 0.5;

    /// Whether the walk may end at vertex i of a path, or of a light sub-path: not where what comes straight from the
    /// emitter makes a path outside the set, nor where nothing can be joined.
    bool may_end(const SubPath& x, int i) const {
        if (i < 1 || !x[i].bsdf.traits().finite) return false;
        return set_.everything || i > 2 || (i == 2 && x[1].specular());
    }

    const Scene& scene_;
    PathSet set_;
    int most_; ///< vertices of a light sub-path
};

} // namespace keyhole
