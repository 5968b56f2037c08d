#include "render/photon_report.h"

#include "core/parallel.h"
#include "core/vec.h"
#include "sampling/image_lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace keyhole {
namespace {

constexpr const char* kBrightest = "photon power, share of the brightest 0.1 %";
constexpr const char* kFound = "photons per lookup";
constexpr const char* kEffective = "photons per lookup, effective";
constexpr const char* kNoise = "cached irradiances, noise of one pass";
constexpr const char* kStarving = "cached irradiances, share of points without";
constexpr const char* kFalse = "photons seen, share of the picture not confirmed by scouts";
constexpr const char* kShare = "photons per lookup, share of those asked for";

/// Beyond these photons are not to be trusted.
constexpr double kMostOfPower = 0.25;
constexpr double kLeastEffective = 0.5; ///< of those found; where that is known
constexpr double kLeastFound = 0.25;
constexpr double kMostStarving = 0.1;
constexpr double kShows = 0.1;       ///< of the light of a sample, or of the picture's mean where that is more
constexpr double kMostFalse = 0.004; ///< of the picture
constexpr double kMostNoise = 0.2;   ///< of irradiance records, where passes don't make it less

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

} // namespace

void report_photons(const Photons& photons, RenderStats& stats) {
    stats.photons_global = photons.global.size();
    stats.photons_caustic = photons.caustic.size();
    stats.values[kBrightest] =
        std::max(share_of_brightest(photons.global.carriers), share_of_brightest(photons.caustic.carriers));
}

void report_lookups(const IrradianceMap& map, double asked, RenderStats& stats) {
    stats.values[kFound] = map.mean_photons();
    stats.values[kEffective] = map.effective_photons();
    stats.values[kShare] = map.mean_photons() / asked;
}

void report_cache(const IrradianceCache& cache, double starving, RenderStats& stats) {
    stats.values["cached irradiances"] = static_cast<double>(cache.size());
    stats.values[kNoise] = cache.noise();
    stats.values[kStarving] = starving;
}

void report_false_spots(const FinalGather& gather, std::uint64_t seed, RenderStats& stats) {
    constexpr int kPoints = 4096;
    std::vector<FinalGather::Confirmation> seen(kPoints);
    parallel_for(kPoints, [&](std::int64_t i) {
        Rng rng(seed, StreamPurpose::survey, static_cast<std::uint64_t>(i));
        seen[static_cast<std::size_t>(i)] = gather.confirm(lattice_image_point(seed, StreamPurpose::survey, i), rng);
    });
    double mean = 0;
    for (const auto& s : seen) mean += s.all / kPoints;
    const auto shows = [&](const auto& s) { return s.unconfirmed > kShows * std::max(s.all, mean); };
    stats.values[kFalse] = static_cast<double>(std::ranges::count_if(seen, shows)) / kPoints;
}

void warn_of_photons(RenderStats& stats, std::int64_t passes) {
    const auto value = [&](const char* name, double otherwise) {
        const auto v = stats.values.find(name);
        return v == stats.values.end() ? otherwise : v->second;
    };
    if (stats.photons_global + stats.photons_caustic == 0) {
        stats.warnings.emplace_back("no photon was stored: only direct light is rendered. If there is more, try more "
                                    "light_paths or mutations");
        return;
    }
    // Where light is brightest no lookup may ask: a room behind a narrow door has most of the power, in few photons.
    if (value(kBrightest, 0) > kMostOfPower && value(kEffective, 0) < kLeastEffective * value(kFound, 1))
        stats.warnings.push_back(fmt::format("the brightest 0.1 % of the photons carry {:.0f} % of the power: expect "
                                             "blotches. Try more passes, or another method",
                                             100 * value(kBrightest, 0)));
    if (value(kShare, 1) < kLeastFound)
        stats.warnings.push_back(fmt::format("the photon map is too sparse where it is asked: {:.1f} photons within "
                                             "reach of a lookup, {:.0f} % of those asked for. Try more photons",
                                             value(kFound, 0), 100 * value(kShare, 1)));
    // Each pass has spots of its own, and shows them less the more passes there are.
    if (const double share = value(kFalse, 0) / std::max(1.0, static_cast<double>(passes)); share > kMostFalse)
        stats.warnings.push_back(fmt::format("in {:.1f} % of the picture a good part of the light comes from a few "
                                             "photons of great power that lie close together: expect bright discs that "
                                             "are not there. Try more photons, light_paths or mutations, more passes, "
                                             "or another method",
                                             100 * share));
    if (const double noise = value(kNoise, 0) / std::sqrt(std::max(1.0, static_cast<double>(passes)));
        noise > kMostNoise)
        stats.warnings.push_back(
            fmt::format("so few gather rays find light that it is known to {:.0f} % only where the "
                        "irradiance cache estimates it (standard error): expect blotches. Try more "
                        "cache_rays, user paths, or another method",
                        100 * noise));
    if (value(kStarving, 0) > kMostStarving)
        stats.warnings.push_back(fmt::format("the irradiance cache has no record for {:.0f} % of what is seen: a few "
                                             "gather rays of each sample have to do, "
                                             "and make noise. Try more spp, or more gather_rays",
                                             100 * value(kStarving, 0)));
}

} // namespace keyhole
