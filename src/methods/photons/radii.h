// Bounds of lookups.
#pragma once

#include "scene/scene.h"

#include <cmath>
#include <cstdint>

namespace keyhole {

/// Radii of lookups follow the size of the scene; they bound how far light can leak, and matter only where photons are
/// so few that the nearest ones lie farther away.
struct Radii {
    float importance, global, caustic; ///< [m]
    float shrink = 1;                  ///< of the regions that come out of a lookup

    /// Areas shrink from pass to pass as (i + 2/3) / (i + 1) (Knaus and Zwicker 2011, eq. 20): bias and variance of the
    /// mean over passes both vanish.
    explicit Radii(const Scene& scene, std::int64_t pass = 0) {
        const float size = (scene.upper() - scene.lower()).length();
        importance = 0.03f * size;
        global = 0.02f * size;
        caustic = 0.02f * size;
        double area = 1;
        for (std::int64_t i = 1; i <= pass; ++i)
            area *= (static_cast<double>(i) + 2.0 / 3) / (static_cast<double>(i) + 1);
        shrink = static_cast<float>(std::sqrt(area));
    }
};

} // namespace keyhole
