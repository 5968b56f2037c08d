#include "scene/emitter.h"

#include <algorithm>

namespace keyhole {

EmitterDistribution::EmitterDistribution(const std::vector<double>& weights) {
    double total = 0;
    for (const double w : weights) total += w;
    if (!(total > 0)) return;
    cumulative_.reserve(weights.size() + 1);
    cumulative_.push_back(0);
    double sum = 0;
    for (const double w : weights) cumulative_.push_back((sum += w) / total);
    // Rounding must not leave a gap below 1, nor give a weightless last entry probability.
    std::replace(cumulative_.begin(), cumulative_.end(), cumulative_.back(), 1.0);
}

std::uint32_t EmitterDistribution::sample(double u) const {
    // The first entry above u: entries of probability zero are never chosen.
    const auto it = std::upper_bound(cumulative_.begin(), cumulative_.end(), u);
    return static_cast<std::uint32_t>(it - cumulative_.begin() - 1);
}

} // namespace keyhole
