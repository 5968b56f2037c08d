#include "gather/gather_effort.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

double best_gather_rays(const GatherEffort& few, const GatherEffort& many) {
    const double of_rays = (few.variance - many.variance) / (1 / few.rays - 1 / many.rays);
    const double of_ray = (many.cost - few.cost) / (many.rays - few.rays);
    const double apart = few.variance - of_rays / few.rays, besides = few.cost - of_ray * few.rays;
    if (!(of_rays > 0)) return few.rays;
    if (!(apart > 0) || !(of_ray > 0)) return many.rays;
    return std::clamp(std::sqrt(of_rays * std::max(besides, 0.0) / (apart * of_ray)), few.rays, many.rays);
}

} // namespace keyhole
