#include "gather/ray_shares.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

std::vector<int> share_rays(std::span<const double> worths, int had, double more) {
    const double most = 64.0 * had;
    const auto share = [&](double worth, double per_unit) {
        return std::clamp(worth * per_unit, static_cast<double>(had), most);
    };
    const auto total = [&](double per_unit) {
        double sum = 0;
        for (const double worth : worths) sum += share(worth, per_unit);
        return sum;
    };
    // Grows with the rays per unit of worth, which are found by halving their range.
    const double wanted = (had + more) * static_cast<double>(worths.size());
    double low = 0, high = 1;
    while (total(high) < wanted && high < 1e12) high *= 2;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (total(middle) < wanted ? low : high) = middle;
    }
    std::vector<int> rays;
    for (const double worth : worths) rays.push_back(static_cast<int>(std::lround(share(worth, low))));
    return rays;
}

} // namespace keyhole
