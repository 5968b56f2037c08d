// How the time of stage three is split between records of the irradiance cache and samples of pixels.
#include "core/statistics.h"
#include "methods/choice/stage_balance.h"
#include "support/settings_from.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr double kPixels = 1e4;

/// A render of 10 s: 4 s each for records and pixels, 2 s for photons.
Experience ten_seconds(const Settings& s) {
    RenderStats stats;
    stats.stages = {{&stages::photons_of_light_paths, 2, 2, 0}, {&stages::cache, 4, 4, 0}, {&stages::gather, 4, 4, 0}};
    return {s, 1, kPixels, stats, 10};
}

Settings settings() { return test::settings_from("cache_rays=1k spp=1k passes=1"); }

/// The squared error that is left with settings `s`.
double error(const Settings& s, const PhotonQuality::Noise& noise) {
    return 0.5 * noise.records * 1000 / static_cast<double>(s.cache_rays) + noise.samples / static_cast<double>(s.spp);
}

TEST(StageBalance, SharesTimeForTheLeastError) {
    for (const double ratio : {1e-3, 0.5, 1.0, 40.0}) {
        const double best = best_share_of_time(ratio, 1);
        const auto error = [&](double share) { return ratio / share + 1 / (1 - share); };
        for (const double share : {0.7 * best, 0.9 * best, 1 - 0.9 * (1 - best), 1 - 0.7 * (1 - best)})
            EXPECT_GT(error(share), error(best)) << ratio << ' ' << share;
    }
    EXPECT_EQ(best_share_of_time(0, 1), 0);
}

TEST(StageBalance, LeavesTheLeastErrorForTheTime) {
    const Settings s = settings();
    const Experience cost = ten_seconds(s);
    for (const double samples : {0.1, 1.0, 10.0}) {
        SCOPED_TRACE(samples);
        const PhotonQuality::Noise noise{samples, 2e-4};
        const Settings best = split_stage_three(s, cost, noise, kPixels, {});
        EXPECT_NEAR(cost.predict(best, kPixels), 10, 0.1);
        EXPECT_EQ(best.light_paths, s.light_paths);
        for (const double factor : {0.5, 0.8, 1.25}) {
            Settings other = best;
            other.cache_rays = static_cast<std::int64_t>(factor * static_cast<double>(best.cache_rays));
            if (other.cache_rays > s.cache_rays) continue; // it gives no more than effort does
            const double left = 8 - 4e-3 * static_cast<double>(other.cache_rays);
            other.spp = static_cast<std::int64_t>(left / 4e-3);
            EXPECT_GE(error(other, noise), 0.999 * error(best, noise)) << factor;
        }
    }
}

TEST(StageBalance, TakesNoiseOfPixelsIntoAccount) {
    const Settings s = settings();
    const Experience cost = ten_seconds(s);
    const Settings calm = split_stage_three(s, cost, {0.1, 2e-4}, kPixels, {});
    const Settings noisy = split_stage_three(s, cost, {10, 2e-4}, kPixels, {});
    EXPECT_LT(noisy.cache_rays, calm.cache_rays / 2);
    EXPECT_GT(noisy.spp, calm.spp);
}

/// A small window had few records, but each of its pixels needed one, and so do those of the picture.
TEST(StageBalance, LeavesTimeToSamplesWhereRecordsGrowAsPixelsDo) {
    const Settings s = settings();
    RenderStats stats;
    stats.stages = {{&stages::cache, 0.25, 0.25, 0}, {&stages::gather, 0.25, 0.25, 0}};
    stats.photon_quality.cache.emplace();
    const auto rays_where_growth_is = [&](double growth) {
        stats.photon_quality.cache->growth = growth;
        const Experience cost(s, 1, kPixels / 16, stats, 0.5);
        return split_stage_three(s, cost, {2, 2e-4}, kPixels, {}).cache_rays;
    };
    ASSERT_LT(rays_where_growth_is(0.25), s.cache_rays);
    EXPECT_EQ(rays_where_growth_is(0), rays_where_growth_is(0.25)) << "rooms have that at least";
    // The best number falls about as the root of what one takes, which is 16^0.5 times as much.
    const auto usual = static_cast<double>(rays_where_growth_is(0.25));
    EXPECT_NEAR(static_cast<double>(rays_where_growth_is(0.75)), 0.5 * usual, 0.1 * usual);
}

/// More where samples are many or good, fewer where records are good by few rays.
TEST(StageBalance, ValuesRaysByWhatSamplesWouldGain) {
    const Experience cost = ten_seconds(settings());
    const double usual = rays_for_pixel({0.1, 1e-3}, cost, 4);
    EXPECT_NEAR(rays_for_pixel({0.1, 1e-3}, cost, 8), 2 * usual, 1e-9 * usual);
    EXPECT_NEAR(rays_for_pixel({0.4, 1e-3}, cost, 4), usual / 2, 1e-9 * usual);
    EXPECT_NEAR(rays_for_pixel({0.1, 4e-3}, cost, 4), 2 * usual, 1e-9 * usual);
    EXPECT_EQ(rays_for_pixel({0, 1e-3}, cost, 4), std::numeric_limits<double>::infinity());
}

TEST(StageBalance, KeepsWhatWasGivenAndWhatNoNoiseTells) {
    const Settings s = settings();
    const Experience cost = ten_seconds(s);
    EXPECT_EQ(split_stage_three(s, cost, {10, 2e-4}, kPixels, {"cache_rays"}).cache_rays, s.cache_rays);
    EXPECT_EQ(split_stage_three(s, cost, {10, 2e-4}, kPixels, {"spp"}).spp, s.spp);
    EXPECT_EQ(split_stage_three(s, cost, {0, 0}, kPixels, {}).cache_rays, s.cache_rays);
}

TEST(StageBalance, GivesChainsThatMakePhotonsTheirShare) {
    const Settings s = settings();
    RenderStats stats;
    stats.stages = {{&stages::photons_of_chains, 0.2, 0.2, 0}, {&stages::cache, 4, 4, 0}, {&stages::gather, 4, 4, 0}};
    const Experience cost(s, 1, kPixels, stats, 8.2);
    const Settings more = split_stage_three(s, cost, {1, 2e-4}, kPixels, {});
    EXPECT_GT(more.mutations, 4 * s.mutations);
    EXPECT_NEAR(cost.predict(more, kPixels), 8.2, 0.2);
}

TEST(StageBalance, GivesPhotonsTheirShare) {
    // What too few photons blur shows in no noise.
    const Settings s = settings();
    RenderStats stats;
    stats.stages = {
        {&stages::photons_of_light_paths, 0.2, 0.2, 0}, {&stages::cache, 4, 4, 0}, {&stages::gather, 4, 4, 0}};
    const Experience cost(s, 1, kPixels, stats, 8.2);
    const Settings more = split_stage_three(s, cost, {1, 2e-4}, kPixels, {});
    EXPECT_GT(more.light_paths, 4 * s.light_paths);
    EXPECT_NEAR(cost.predict(more, kPixels), 8.2, 0.2);
    EXPECT_EQ(split_stage_three(s, cost, {1, 2e-4}, kPixels, {"light_paths"}).light_paths, s.light_paths);
}

TEST(StageBalance, CountsTheIrradianceThatPhotonsAreAskedFor) {
    Settings s = settings();
    s.photons = 10'000;
    RenderStats stats;
    stats.stages = {{&stages::photons_of_light_paths, 0.2, 0.2, 0},
                    {&stages::irradiance, 1.4, 1.4, 0},
                    {&stages::cache, 4, 4, 0},
                    {&stages::gather, 4, 4, 0}};
    const Experience cost(s, 1, kPixels, stats, 9.6);
    EXPECT_EQ(split_stage_three(s, cost, {1, 2e-4}, kPixels, {}).light_paths, s.light_paths) << "they have their share";
    s.photons *= 3;
    EXPECT_NEAR(cost.predict(s, kPixels), 9.6 + 2 * 1.4, 1e-6);
}

} // namespace
} // namespace keyhole
