// How many gather rays a sample of a pixel should trace.
#pragma once

#include <algorithm>
#include <cmath>

namespace keyhole {

/// Samples of pixels that trace `rays` gather rays each where their whole BSDF is gathered.
struct GatherEffort {
    double rays;
    double variance; ///< of a sample
    double cost;     ///< of a sample, in any unit
};

/// The number of rays for which variance times cost, which the squared error goes with at equal cost, is least, within
/// the range of those two that were tried. Variance goes as a + b / rays and cost as c + d rays, so that it is
/// sqrt(b c / (a d)).
inline double best_gather_rays(const GatherEffort& few, const GatherEffort& many) {
    const double of_rays = (few.variance - many.variance) / (1 / few.rays - 1 / many.rays);
    const double of_ray = (many.cost - few.cost) / (many.rays - few.rays);
    const double apart = few.variance - of_rays / few.rays, besides = few.cost - of_ray * few.rays;
    if (!(of_rays > 0)) return few.rays;
    if (!(apart > 0) || !(of_ray > 0)) return many.rays;
    return std::clamp(std::sqrt(of_rays * std::max(besides, 0.0) / (apart * of_ray)), few.rays, many.rays);
}

} // namespace keyhole
