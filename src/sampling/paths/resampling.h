// Choices in proportion to weights.
#pragma once

#include "core/rng.h"

#include <cstdint>

namespace keyhole {

/// Calls choose(item) `count` times in all, in the order of `items`, for each of them weight(item) / total * count
/// times on average, up or down to the next whole number. Not at all if all weights are 0.
template <class Items, class Weight, class Choose>
void resample_systematically(const Items& items, std::int64_t count, Rng& rng, Weight&& weight, Choose&& choose) {
    double total = 0;
    for (const auto& item : items) total += weight(item);
    const double shift = rng.next();
    double passed = 0;
    std::int64_t chosen = 0;
    for (const auto& item : items) {
        const double w = weight(item);
        if (!(w > 0)) continue;
        passed += w;
        for (; chosen < count && (static_cast<double>(chosen) + shift) / static_cast<double>(count) * total < passed;
             ++chosen)
            choose(item);
    }
}

} // namespace keyhole
