#include "methods/choice/stage_balance.h"

#include "core/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

/// Share of the rays of records that these have at first, when their noise is told.
constexpr double kRaysAtFirst = 0.5;
/// Records with fewer rays don't see what is around them.
constexpr double kLeastRays = 64;
/// Of the time of all stages that settings have a say in, what light paths or chains take at least, with the irradiance
/// that is made of their photons. Too few photons blur light, which no noise tells.
constexpr double kLeastForPhotons = 0.15, kMostMorePhotons = 8;
/// Records overlap, and each serves pixels on all sides of it: so many times across as are between two of its level.
/// Half and double make no difference beyond noise.
constexpr double kServed = 3;
/// Of the samples of pixels that effort gives.
constexpr double kLeastSamples = 0.5;

/// CPU time of stages [s].
double seconds_of(Stage::Work work, const RenderStats& stats) {
    double seconds = 0;
    for (const StageStats& s : stats.stages)
        if (s.stage->work == work) seconds += s.cpu_seconds;
    return seconds;
}

} // namespace

Settings split_stage_three(const Settings& settings, const Experience& cost, const PhotonQuality::Noise& noise,
                           double pixels, const std::set<std::string>& given) {
    if (given.contains("cache_rays") || given.contains("spp") || !(noise.records > 0) || !(noise.samples > 0))
        return settings;
    const auto seconds = [&](const Stage& of) {
        double sum = 0;
        for (const auto& [stage, time] : cost.stages)
            if (stage == &of) sum += cost.predict(*stage, time, settings, pixels);
        return sum;
    };
    const double records = seconds(stages::cache), samples = seconds(stages::gather);
    const double photons =
        seconds(stages::photons_of_light_paths) + seconds(stages::photons_of_chains) + seconds(stages::irradiance);
    if (!(records > 0 && samples > 0)) return settings;
    Settings s = settings;
    const double more = kLeastForPhotons * (records + samples + photons) - photons;
    if (photons > 0 && more > 0 && !given.contains("light_paths") && !given.contains("mutations") &&
        !given.contains("photons")) {
        const double factor = std::min(kMostMorePhotons, 1 + more / photons);
        s.light_paths = static_cast<std::int64_t>(factor * static_cast<double>(s.light_paths));
        s.mutations = static_cast<std::int64_t>(factor * static_cast<double>(s.mutations));
        s.photons = static_cast<std::int64_t>(factor * static_cast<double>(s.photons));
    }
    const auto rays = static_cast<double>(s.cache_rays), spp = static_cast<double>(s.spp);
    const double of_records = noise.records * kRaysAtFirst * static_cast<double>(cost.settings.cache_rays) / rays;
    const double of_samples = noise.samples / spp;
    // What all records would take, not only those that the effort counts on.
    const double whole = records * std::pow(pixels / cost.pixels, cost.cache_power - stages::cache.pixel_power);
    const double share = best_share_of_time(of_records * whole, of_samples * samples);
    const double both = records + samples - std::max(more, 0.0);
    s.cache_rays = static_cast<std::int64_t>(std::clamp(rays * both * share / whole, std::min(rays, kLeastRays), rays));
    const double left = both - records * static_cast<double>(s.cache_rays) / rays;
    s.spp = std::max<std::int64_t>(1, static_cast<std::int64_t>(spp * std::max(left / samples, kLeastSamples)));
    return s;
}

/// A record of r rays that serves s^2 pixels has the error s^2 V / r there, with V of one ray; all pixels have A / S
/// with S samples. The last ray of a record gains s^2 V / r^2, and that time spent on samples A / S^2, about: as much
/// where r is s S (V / A)^(1/2).
double rays_for_pixel(const PhotonQuality::Noise& noise, const Experience& cost, double spp) {
    const double of_ray = noise.records * kRaysAtFirst * static_cast<double>(cost.settings.cache_rays);
    return noise.samples > 0 ? kServed * spp * std::sqrt(of_ray / noise.samples)
                             : std::numeric_limits<double>::infinity();
}

/// Least factor on stage one where there may be caustics. Of those seen by way of glass one path in thousands tells,
/// and without one brightness seems well known; wrong, it is wrong in all of the caustics.
constexpr double kLeastForCaustics = 0.8;

StageBalance rebalance(const StageBalance& balance, const RenderStats& stats, bool caustics) {
    const double one = seconds_of(Stage::Work::brightness, stats), two = seconds_of(Stage::Work::chains, stats);
    if (!stats.agreement || !(stats.agreement->error > 0 && stats.brightness > 0 && one > 0 && two > 0)) return balance;
    const double of_one = stats.brightness_error / stats.brightness, of_two = stats.agreement->error;
    const double share = best_share_of_time(of_one * of_one * one, of_two * of_two * two);
    // Bounds, for what short renders say of their errors is vague; and groups of chains that agree too well, as those
    // do that have not mixed, think their error smaller than it is.
    return {std::clamp(balance.brightness * share * (one + two) / one, caustics ? kLeastForCaustics : 0.25, 1.2),
            std::clamp(balance.chains * (1 - share) * (one + two) / two, 0.9, 4.0)};
}

} // namespace keyhole
