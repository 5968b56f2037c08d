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

/// What a record gives away.
struct Gift {
    std::uint32_t from;
    Rgb light; ///< [W/m^2]
    std::vector<IrradianceCache::Say> others;
};

/// Area that a record stands for, up to a factor.
double area(const IrradianceCache& cache, std::size_t i) {
    return static_cast<double>(cache.radius(i)) * cache.radius(i);
}

/// What `others` say of their place: the mean, and by how much the luminance of one of them departs from it [W/m^2].
struct Opinion {
    Rgb mean{0.0};
    double spread = 0;
    explicit Opinion(std::span<const IrradianceCache::Say> others) {
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

/// Of record `i`, whose light has the standard error `noise` relative to itself, as the others tell it.
std::optional<Gift> gift_of(const IrradianceCache& cache, std::uint32_t i, double noise) {
    const Rgb light = cache.light(i);
    const double here = luminance(light);
    if (!(here > 0)) return std::nullopt;
    std::vector<IrradianceCache::Say> others = cache.others_at(i);
    if (others.size() < kLeastOthers) return std::nullopt;
    const Opinion opinion(others);
    const double mean = luminance(opinion.mean);
    const double allowed = mean + std::max(kStandardErrors * noise * mean, opinion.spread);
    const double too_much = std::min(here - allowed, kOwnErrors * std::sqrt(cache.variance(i)));
    if (!(too_much > 0 && mean > 0)) return std::nullopt;
    // What is too much has a colour of its own.
    Rgb excess;
    for (int c = 0; c < 3; ++c) excess[c] = std::max(0.0, light[c] - opinion.mean[c]);
    return Gift{i, excess * (too_much / luminance(excess)), std::move(others)};
}

} // namespace

double share_outlying_light(IrradianceCache& cache) {
    const std::vector<double> noise = cache.relative_noise();
    std::vector<Gift> gifts;
    for (std::uint32_t i = 0; i < cache.size(); ++i)
        if (auto gift = gift_of(cache, i, noise[i])) gifts.push_back(std::move(*gift));
    for (const Gift& gift : gifts) {
        double sum = 0;
        for (const auto& o : gift.others) sum += o.weight * luminance(cache.light(o.record)) * area(cache, o.record);
        if (!(sum > 0)) continue;
        const double given = area(cache, gift.from) / sum;
        cache.change(gift.from, -gift.light);
        for (const auto& o : gift.others)
            cache.change(o.record, gift.light * (o.weight * luminance(cache.light(o.record)) * given));
    }
    return cache.size() > 0 ? static_cast<double>(gifts.size()) / static_cast<double>(cache.size()) : 0;
}

} // namespace keyhole
