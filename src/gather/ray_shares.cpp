#include "gather/ray_shares.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

std::vector<int> share_rays(std::span<const double> weights, int had, double more) {
    if (weights.empty()) return {};
    const double best = std::max(*std::max_element(weights.begin(), weights.end()), 1e-300);
    const auto share = [&](double weight, double of_best) {
        return std::clamp(weight / best * of_best, static_cast<double>(had), 64.0 * had);
    };
    const auto total = [&](double of_best) {
        double sum = 0;
        for (const double weight : weights) sum += share(weight, of_best);
        return sum;
    };
    // The total grows with what the best would get without a bound, which is found by halving its range.
    const double wanted = (had + more) * static_cast<double>(weights.size());
    double low = 0, high = had;
    while (total(high) < wanted && high < 1e12) high *= 2;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (total(middle) < wanted ? low : high) = middle;
    }
    std::vector<int> rays;
    for (const double weight : weights) rays.push_back(static_cast<int>(std::lround(share(weight, low))));
    return rays;
}

} // namespace keyhole
