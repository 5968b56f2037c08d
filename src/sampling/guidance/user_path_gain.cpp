#include "sampling/guidance/user_path_gain.h"

#include "core/statistics.h"

#include <algorithm>

namespace keyhole {

void GuidanceTally::add(std::int64_t chain, const Vec2& image, double weight) {
    const auto block = [](float x) { return std::clamp(static_cast<int>(x * kAcross), 0, kAcross - 1); };
    sums_[static_cast<std::size_t>(chain)][static_cast<std::size_t>(block(image.y) * kAcross + block(image.x))] +=
        weight;
}

std::optional<GuidanceEffect> GuidanceTally::effect() const {
    GuidanceEffect effect;
    double scale = 0;
    for (std::size_t b = 0; b < kBlocks; ++b) {
        RunningStats with, without;
        for (std::size_t c = 0; c < sums_.size(); ++c)
            (is_control(first_ + static_cast<std::int64_t>(c)) ? without : with).add(sums_[c][b]);
        effect.chains_with = static_cast<std::size_t>(with.count());
        effect.chains_without = static_cast<std::size_t>(without.count());
        if (effect.chains_with < 2 || effect.chains_without < 2) return std::nullopt;
        effect.with += with.variance();
        effect.without += without.variance();
        RunningStats all = with;
        all.merge(without);
        scale += all.mean() * all.mean();
    }
    if (!(scale > 0)) return std::nullopt;
    effect.with /= scale;
    effect.without /= scale;
    return effect;
}

} // namespace keyhole
