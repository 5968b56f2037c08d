#include "gather/outlying_records.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace keyhole {
namespace {

/// Standard errors, as the others' noise tells them, that a record may be brighter than the others say.
constexpr double kStandardErrors = 2;
/// The same of its own variance: what a record's own rays agree on is no outlier.
constexpr double kOwnErrors = 1.5;
/// Others that it takes to tell.
constexpr std::size_t kLeastOthers = 4;

/// Light that a record has beyond what its neighbours predict, which it gives away to them.
struct Excess {
    std::uint32_t from;
    Rgb light; ///< [W/m^2]
    std::vector<IrradianceCache::Prediction> others;
};

/// Area that a record stands for, up to a factor.
double area(const IrradianceCache& cache, std::size_t i) {
    return static_cast<double>(cache.radius(i)) * cache.radius(i);
}

/// The weighted mean of the predictions, and the standard deviation of their luminance [W/m^2].
struct Consensus {
    Rgb mean{0.0};
    double spread = 0;
    explicit Consensus(std::span<const IrradianceCache::Prediction> others) {
        double weights = 0, squares = 0;
        for (const auto& o : others) {
            const double y = luminance(o.irradiance);
            weights += o.weight;
            mean += o.irradiance * o.weight;
            squares += o.weight * y * y;
        }
        if (!(weights > 0)) return;
        mean /= weights;
        const double y = luminance(mean);
        spread = std::sqrt(std::max(0.0, squares / weights - y * y));
    }
};

/// The excess of record `i`, if any; `noise`: the standard error of the light around it, relative to that light.
std::optional<Excess> excess_of(const IrradianceCache& cache, std::uint32_t i, double noise) {
    const Rgb light = cache.light(i);
    const double here = luminance(light);
    if (!(here > 0)) return std::nullopt;
    std::vector<IrradianceCache::Prediction> others = cache.others_at(i);
    if (others.size() < kLeastOthers) return std::nullopt;
    const Consensus consensus(others);
    const double mean = luminance(consensus.mean);
    const double allowed = mean + std::max(kStandardErrors * noise * mean, consensus.spread);
    const double too_much = std::min(here - allowed, kOwnErrors * std::sqrt(cache.variance(i)));
    if (!(too_much > 0 && mean > 0)) return std::nullopt;
    // What is too much has a colour of its own.
    Rgb excess;
    for (int c = 0; c < 3; ++c) excess[c] = std::max(0.0, light[c] - consensus.mean[c]);
    return Excess{i, excess * (too_much / luminance(excess)), std::move(others)};
}

} // namespace

double share_outlying_light(IrradianceCache& cache) {
    const std::vector<double> noise = cache.relative_noise();
    std::vector<Excess> excesses;
    for (std::uint32_t i = 0; i < cache.size(); ++i)
        if (auto excess = excess_of(cache, i, noise[i])) excesses.push_back(std::move(*excess));
    for (const Excess& excess : excesses) {
        double sum = 0;
        for (const auto& o : excess.others) sum += o.weight * luminance(cache.light(o.record)) * area(cache, o.record);
        if (!(sum > 0)) continue;
        const double given = area(cache, excess.from) / sum;
        cache.change(excess.from, -excess.light);
        for (const auto& o : excess.others)
            cache.change(o.record, excess.light * (o.weight * luminance(cache.light(o.record)) * given));
    }
    return cache.size() > 0 ? static_cast<double>(excesses.size()) / static_cast<double>(cache.size()) : 0;
}

} // namespace keyhole
