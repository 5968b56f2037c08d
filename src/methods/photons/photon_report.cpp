#include "methods/photons/photon_report.h"

#include "core/parallel.h"
#include "core/statistics.h"
#include "core/vec.h"
#include "film/image_error.h"
#include "photonmap/power.h"
#include "sampling/paths/image_lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace keyhole {
namespace {

/// Beyond these photons are not to be trusted.
constexpr double kMostOfPower = 0.25;
constexpr double kMostCutOff = 0.1;     ///< of the power, with outliers
constexpr double kLeastEffective = 0.5; ///< of those found; where that is known
constexpr double kLeastFound = 0.25;
constexpr double kMostStarving = 0.1;
constexpr double kShows = 0.1;       ///< of the light of a sample, or of the picture's mean where that is more
constexpr double kMostFalse = 0.004; ///< of the picture
constexpr double kMostNoise = 0.2;   ///< of irradiance records, where passes don't make it less
constexpr double kNoiseShows = 0.05; ///< of the picture, from records: less of it is no blotch

constexpr int kPoints = 4096;  // of the picture that are looked at for false spots
constexpr double kMost = 0.98; // of pixels: the rest hold bright, rare samples, which say nothing of the others

double share_of_brightest(const std::vector<Photon>& photons) {
    if (photons.empty()) return 0;
    std::vector<double> powers;
    powers.reserve(photons.size());
    for (const Photon& p : photons) powers.push_back(luminance(p.power()));
    const auto few = powers.begin() + static_cast<std::ptrdiff_t>((powers.size() + 999) / 1000);
    std::ranges::nth_element(powers, few - 1, std::greater<>());
    const double all = std::accumulate(powers.begin(), powers.end(), 0.0);
    return all > 0 ? std::accumulate(powers.begin(), few, 0.0) / all : 0;
}

/// The mean without the largest.
double mean_of_most(std::vector<double>& values) {
    const auto most = values.begin() + static_cast<std::ptrdiff_t>(kMost * static_cast<double>(values.size()));
    std::ranges::nth_element(values, most);
    return std::accumulate(values.begin(), most, 0.0) / static_cast<double>(most - values.begin());
}

} // namespace

void report_photons(const Photons& photons, RenderStats& stats) {
    stats.photons_global = photons.global.size();
    stats.photons_caustic = photons.caustic.size();
    stats.photon_quality.of_brightest =
        std::max(share_of_brightest(photons.global.main_photons), share_of_brightest(photons.caustic.main_photons));
}

void cut_outliers(Photons& photons, std::int64_t passes, RenderStats& stats) {
    if (passes != 1) return;
    stats.photon_quality.cut_off =
        std::max(cut_outlying_power(photons.global.main_photons), cut_outlying_power(photons.caustic.main_photons));
}

void report_lookups(const IrradianceMap& map, double asked, RenderStats& stats) {
    stats.photon_quality.lookups = {map.mean_photons(), map.effective_photons(), map.mean_photons() / asked};
}

void report_cache(const IrradianceCache& cache, double starving, RenderStats& stats) {
    stats.photon_quality.cache = {static_cast<double>(cache.size()), cache.noise(), starving, cache.growth()};
}

void report_false_spots(const FinalGather& gather, std::uint64_t seed, RenderStats& stats) {
    std::vector<FinalGather::Doubts> seen(kPoints);
    parallel_for(kPoints, [&](std::int64_t i) {
        Rng rng(seed, StreamPurpose::survey, static_cast<std::uint64_t>(i));
        seen[static_cast<std::size_t>(i)] =
            gather.doubt(lattice_image_point(seed, StreamPurpose::survey, i), true, rng);
    });
    double mean = 0;
    for (const auto& s : seen) mean += s.all / kPoints;
    const auto shows = [&](const auto& s) { return s.unconfirmed > kShows * std::max(s.all, mean); };
    stats.photon_quality.unconfirmed = static_cast<double>(std::ranges::count_if(seen, shows)) / kPoints;
}

std::optional<PhotonQuality::Noise> noise_of(const FinalGather& gather, const ImageWindow& window, std::uint64_t seed,
                                             int pixels) {
    // In a quarter of a pixel: where the window is that of a trial, its pixels are larger than the picture's.
    constexpr double kWidth = 0.25;
    struct Pixel {
        double mean = 0, variance = 0, of_records = 0, rays = 0;
    };
    std::vector<Pixel> seen_pixels(static_cast<std::size_t>(pixels));
    parallel_for(pixels, [&](std::int64_t i) {
        Rng rng(seed, StreamPurpose::survey, static_cast<std::uint64_t>(kPoints + i));
        const Vec2 corner = lattice_image_point(seed, StreamPurpose::survey, i);
        RunningStats seen;
        Pixel& pixel = seen_pixels[static_cast<std::size_t>(i)];
        for (int k = 0; k < kSamplesInPixel; ++k) {
            const double across = kWidth * rng.next() / window.width, down = kWidth * rng.next() / window.height;
            const Vec2 at(std::min(corner.x + static_cast<float>(across), 0x1.fffffep-1f),
                          std::min(corner.y + static_cast<float>(down), 0x1.fffffep-1f));
            const FinalGather::Doubts sample = gather.doubt(at, false, rng);
            seen.add(sample.all);
            pixel.of_records += sample.of_records / kSamplesInPixel;
            pixel.rays += static_cast<double>(sample.rays) / kSamplesInPixel;
        }
        pixel.mean = seen.mean();
        pixel.variance = seen.variance();
    });
    double mean = 0, rays = 0;
    for (const Pixel& p : seen_pixels) {
        mean += p.mean / pixels;
        rays += p.rays / pixels;
    }
    const auto relative = [&](double squared, const Pixel& p) { return squared / error_unit(p.mean, mean); };
    std::vector<double> samples, records;
    for (const Pixel& p : seen_pixels) {
        samples.push_back(relative(p.variance, p));
        records.push_back(relative(p.of_records * p.of_records, p));
    }
    if (!(mean > 0)) return std::nullopt;
    return PhotonQuality::Noise{mean_of_most(samples), mean_of_most(records), rays};
}

void warn_of_photons(RenderStats& stats, std::int64_t passes, std::int64_t max_depth) {
    const PhotonQuality& q = stats.photon_quality;
    const auto lookups = q.lookups.value_or(PhotonQuality::Lookups{0, 0, 1});
    const auto cache = q.cache.value_or(PhotonQuality::Cache{});
    const double brightest = q.of_brightest.value_or(0), all_passes = std::max(1.0, static_cast<double>(passes));
    // Of two scatterings the second is lit directly, or by caustics.
    const bool asked = max_depth > 2;
    if (stats.photons_global + stats.photons_caustic == 0) {
        if (asked)
            stats.warn(Doubt::photons,
                       "no photon was stored: only direct light is rendered. If there is more, try more "
                       "light_paths or mutations");
        return;
    }
    // Where light is brightest no lookup may ask: a room behind a narrow door has most of the power, in few photons.
    if (brightest > kMostOfPower && lookups.effective < kLeastEffective * (q.lookups ? lookups.found : 1))
        stats.warn(Doubt::photons, fmt::format("the brightest 0.1 % of the photons carry {:.0f} % of the power: expect "
                                               "blotches. Try more passes, or another method",
                                               100 * brightest));
    if (const double cut = q.cut_off.value_or(0); cut > kMostCutOff)
        stats.warn(Doubt::photons, fmt::format("so few photons bring so much of the light that {:.0f} % of the "
                                               "photons' power was cut off as outliers: the picture may be too dark. "
                                               "Try more light_paths or time, or more passes, which cut nothing off",
                                               100 * cut));
    if (lookups.share < kLeastFound && asked)
        stats.warn(Doubt::lookups,
                   fmt::format("the photon map is too sparse where it is asked: {:.1f} photons within "
                               "reach of a lookup, {:.0f} % of those asked for. Try more light_paths, mutations or "
                               "time, or more photon_memory where that is full",
                               lookups.found, 100 * lookups.share));
    // Each pass has spots of its own, and shows them less the more passes there are.
    if (const double share = q.unconfirmed.value_or(0) / all_passes; share > kMostFalse)
        stats.warn(Doubt::caustics,
                   fmt::format("in {:.1f} % of the picture a good part of the light comes from a few "
                               "photons of great power that lie close together: expect bright discs that "
                               "are not there. Try more photons, light_paths or mutations, more passes, "
                               "or another method",
                               100 * share));
    const double noise = cache.noise / std::sqrt(all_passes);
    // What is known badly may be next to nothing beside direct light.
    const bool shows = !q.noise || std::sqrt(q.noise->records / all_passes) > kNoiseShows;
    if (noise > kMostNoise && shows)
        stats.warn(Doubt::records,
                   fmt::format("so few gather rays find light that it is known to {:.0f} % only where the "
                               "irradiance cache estimates it (standard error): expect blotches. Try more "
                               "cache_rays, user paths, or another method",
                               100 * noise));
    if (cache.starving > kMostStarving)
        stats.warn(Doubt::records, fmt::format("the irradiance cache has no record for {:.0f} % of what is seen: a few "
                                               "gather rays of each sample have to do, "
                                               "and make noise. Try more spp, or more gather_rays",
                                               100 * cache.starving));
}

} // namespace keyhole
