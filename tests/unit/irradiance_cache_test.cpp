#include "gather/irradiance_cache.h"

#include "core/rng.h"
#include "core/statistics.h"
#include "gather/fill_cache.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr float kMin = 0.01f, kMax = 10;

/// One so uncertain that it contradicts no other.
IrradianceRecord record(const Vec3& p, double e, double distance, const Vec3& slope = Vec3(0.0f),
                        const Vec3& n = {0, 0, 1}) {
    IrradianceRecord r{p, n, {}, kMin, kMax};
    r.light.irradiance = Rgb(e);
    r.light.translation = {slope, slope, slope};
    r.light.distance = distance;
    r.light.variance = 1e6;
    return r;
}

bool covers(const IrradianceCache& cache, const Vec3& p, float share, bool seen = true) {
    return cache.covers(p, {0, 0, 1}, share, [&](const Vec3& /*record*/) { return seen; });
}

TEST(IrradianceCache, IsExactAtARecordAndSilentBeyondItsReach) {
    IrradianceCache cache(0.2f);
    EXPECT_FALSE(cache.irradiance({0, 0, 0}, {0, 0, 1}).known);
    cache.insert(record({1, 2, 3}, 5, 1));
    const auto there = cache.irradiance({1, 2, 3}, {0, 0, 1});
    EXPECT_DOUBLE_EQ(there.irradiance.y, 5);
    EXPECT_TRUE(covers(cache, {1, 2, 3}, 1));
    EXPECT_FALSE(covers(cache, {1, 2, 3}, 1, false)) << "a record that a wall hides covers nothing";
    EXPECT_TRUE(covers(cache, {1.19f, 2, 3}, 1e-6f));
    EXPECT_FALSE(covers(cache, {1.21f, 2, 3}, 1e-6f)) << "another record is wanted";
    EXPECT_TRUE(cache.irradiance({1.39f, 2, 3}, {0, 0, 1}).known) << "but this one may still be used";
    EXPECT_FALSE(cache.irradiance({1.41f, 2, 3}, {0, 0, 1}).known);
}

TEST(IrradianceCache, AveragesTheNoiseOfItsRecords) {
    // Records as far apart as filling leaves them, each off by its own noise of variance 1: a say that only the nearest
    // have would leave most of it.
    Rng rng(1, StreamPurpose::test, 0);
    IrradianceCache cache(0.2f);
    constexpr int kSide = 30;
    for (int x = 0; x < kSide; ++x)
        for (int y = 0; y < kSide; ++y) {
            const Vec3 p(0.2f * static_cast<float>(x), 0.2f * static_cast<float>(y), 0);
            cache.insert(record(p, 10 + std::sqrt(12.0) * (rng.next() - 0.5), 1));
        }
    RunningStats stats;
    for (int i = 0; i < 2000; ++i) {
        const auto at = [&] { return static_cast<float>(1 + 4 * rng.next()); };
        const float x = at(), y = at();
        stats.add(cache.irradiance({x, y, 0}, {0, 0, 1}).irradiance.x);
    }
    EXPECT_NEAR(stats.mean(), 10, 0.1);
    EXPECT_LT(stats.variance(), 0.3);
}

TEST(IrradianceCache, EndsARecordWhereMuchFinerOnesStand) {
    IrradianceCache cache(0.2f);
    cache.insert(record({0, 0, 0}, 1, 1));
    EXPECT_FLOAT_EQ(cache.reach(0), 0.4f);
    cache.insert(record({0.3f, 0, 0}, 1, 0.75)); // radius 0.15: not so much finer
    EXPECT_FLOAT_EQ(cache.reach(0), 0.4f);
    cache.insert(record({0, 0.25f, 0}, 1, 0.8, {0, 2, 0})); // changes by its own size within 0.5 m: radius 0.1
    EXPECT_FLOAT_EQ(cache.radius(2), 0.1f);
    EXPECT_FLOAT_EQ(cache.radius(0), 0.15f) << "clamped by what its neighbour is near to";
    EXPECT_FLOAT_EQ(cache.reach(0), 0.3f);
    cache.insert(record({0, -0.2f, 0}, 1, 0.8, {0, 4, 0})); // radius 0.05
    EXPECT_FLOAT_EQ(cache.radius(0), 0.09f);
    EXPECT_FLOAT_EQ(cache.reach(0), 0.18f);
}

TEST(IrradianceCache, ReproducesALinearField) {
    const Vec3 slope(0.7f, -0.4f, 0);
    const auto field = [&](const Vec3& p) { return 5.0 + p.dot(slope); };
    IrradianceCache cache(0.3f);
    for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 8; ++y) {
            const Vec3 p(0.25f * static_cast<float>(x), 0.3f * static_cast<float>(y), 0);
            cache.insert(record(p, field(p), 1.5, slope));
        }
    for (float x = 0; x < 1.7f; x += 0.11f) {
        const Vec3 p(x, 0.5f * x + 0.1f, 0);
        EXPECT_NEAR(cache.irradiance(p, {0, 0, 1}).irradiance.x, field(p), 1e-4);
    }
}

TEST(IrradianceCache, BlendsWithoutSteps) {
    // Records that contradict each other, of different reach: the worst that noise can do.
    IrradianceCache cache(0.2f);
    for (int i = 0; i < 12; ++i)
        cache.insert(record({0.1f * static_cast<float>(i), 0.03f * static_cast<float>(i % 3), 0}, 1.0 + i % 2,
                            1.0 + 0.4 * (i % 4)));
    double last = cache.irradiance({0.1f, 0.02f, 0}, {0, 0, 1}).irradiance.x;
    for (float x = 0.1f; x < 1; x += 0.001f) {
        const double now = cache.irradiance({x, 0.02f, 0}, {0, 0, 1}).irradiance.x;
        EXPECT_NEAR(now, last, 0.02) << "at " << x;
        last = now;
    }
}

TEST(IrradianceCache, KeepsToItsSurface) {
    IrradianceCache cache(0.5f);
    cache.insert(record({0, 0, 0}, 1, 1));
    EXPECT_TRUE(cache.irradiance({0.2f, 0, 0}, {0, 0, 1}).known);
    EXPECT_FALSE(cache.irradiance({0.2f, 0, 0}, {0, 0, -1}).known) << "the other side of a sheet";
    EXPECT_FALSE(cache.irradiance({0.2f, 0, 0}, {1, 0, 0}).known) << "another wall";
    EXPECT_FALSE(cache.irradiance({0.2f, 0, 0.2f}, {0, 0, 1}).known) << "the next step of a stair";
    EXPECT_FALSE(cache.irradiance({0.2f, 0, -0.2f}, {0, 0, 1}).known) << "behind the record";
}

TEST(IrradianceCache, TurnsWithTheNormal) {
    IrradianceCache cache(0.5f);
    IrradianceRecord r = record({0, 0, 0}, 2, 1);
    r.light.rotation[0] = {3, 0, 0};
    cache.insert(r);
    const Vec3 n = Vec3(0.1f, 0, 1).normalized();
    EXPECT_NEAR(cache.irradiance({0, 0, 0}, n).irradiance.x, 2 + 3 * n.x, 1e-5);
    EXPECT_NEAR(cache.irradiance({0, 0, 0}, n).irradiance.y, 2, 1e-5);
}

TEST(IrradianceCache, ClampsRadiiByNeighboursAndBounds) {
    IrradianceCache cache(0.2f);
    cache.insert(record({0, 0, 0}, 1, 5));
    EXPECT_FLOAT_EQ(cache.radius(0), 1);
    cache.insert(record({0.5f, 0, 0}, 1, 1)); // sees something 1 m away: from the first it is 1.5 m
    EXPECT_FLOAT_EQ(cache.radius(0), 0.3f);
    cache.insert(record({0.1f, 0, 0}, 1, 9));
    EXPECT_FLOAT_EQ(cache.radius(2), 0.2f * 1.4f);
    cache.insert(record({9, 0, 0}, 1, 1e-3));
    EXPECT_FLOAT_EQ(cache.radius(3), kMin);
    cache.insert(record({-90, 0, 0}, 1, std::numeric_limits<double>::infinity()));
    EXPECT_FLOAT_EQ(cache.radius(4), kMax);
}

TEST(IrradianceCache, LightShortensARecordLessThanWhatStandsAroundMay) {
    IrradianceCache cache(0.2f);
    const auto insert = [&](float x, double distance, float slope) {
        IrradianceRecord r = record({x, 0, 0}, 1, distance, {slope, 0, 0});
        r.min_radius_by_light = 0.5f;
        cache.insert(r);
        return cache.radius(cache.size() - 1);
    };
    EXPECT_FLOAT_EQ(insert(0, 5, 1), 0.5f) << "changes by its own size within 1 m: 0.2 m";
    EXPECT_FLOAT_EQ(insert(100, 1, 0), 0.2f);
    EXPECT_NEAR(cache.irradiance({0.1f, 0, 0}, {0, 0, 1}).irradiance.x, 1 + 0.1 * 0.4, 1e-5)
        << "the gradient holds within 0.2 of 0.5 m";
    insert(0.05f, 0.5, 0);
    EXPECT_FLOAT_EQ(cache.radius(0), 0.2f * 0.55f) << "what a neighbour sees stands around this one, too";
}

/// What records make wrong together must vanish with passes, in about the same time a pass: finer, with fewer rays.
TEST(CacheOptions, ShrinkFromPassToPass) {
    Settings s;
    s.cache_rays = 1600;
    const CacheOptions first = cache_options(s, 1, 1), later = cache_options(s, 0.5, 1),
                       late = cache_options(s, 0.01, 1);
    EXPECT_DOUBLE_EQ(later.error, first.error / 2);
    EXPECT_DOUBLE_EQ(first.min_radius, s.cache_min_reach);
    EXPECT_DOUBLE_EQ(later.min_radius, first.min_radius / 2);
    EXPECT_DOUBLE_EQ(later.min_radius_by_light, first.min_radius_by_light / 2);
    EXPECT_DOUBLE_EQ(later.max_radius, first.max_radius / 2);
    EXPECT_EQ(first.rays, 1600);
    EXPECT_EQ(later.rays, 400);
    EXPECT_EQ(late.rays, 64) << "fewer don't tell how far a record is good for";
    EXPECT_DOUBLE_EQ(first.overlap, 2);
    EXPECT_DOUBLE_EQ(later.overlap, 1);
    EXPECT_DOUBLE_EQ(first.doubt, later.doubt) << "the rays of all passes count";
    s.cache_rays = 16;
    EXPECT_EQ(cache_options(s, 0.01, 1).rays, 16) << "as few as were asked for";
}

TEST(IrradianceCache, ReachEndsWhereTheGradientStopsHolding) {
    IrradianceCache cache(0.2f);
    cache.insert(record({0, 0, 0}, 1, 5, {1, 0, 0})); // changes by its own size within 1 m
    EXPECT_FLOAT_EQ(cache.radius(0), 0.2f);
}

/// Light that peaks about x = 1, and a record of it whose rays missed that it does: without a gradient.
double peak(double x) { return 1 + 8 * std::exp(-50 * (x - 1) * (x - 1)); }
IrradianceRecord peak_record(float x) {
    IrradianceRecord r = record({x, 0, 0}, peak(x), 2);
    r.light.variance = 0;
    return r;
}

TEST(IrradianceCache, GetsFinerWhereGradientsContradictEachOther) {
    IrradianceCache cache(0.3f);
    std::size_t flat = 0, curved = 0;
    for (const float step : {0.4f, 0.2f, 0.1f, 0.05f, 0.02f, 0.01f})
        for (float x = -2; x < 2; x += step)
            if (!covers(cache, {x, 0, 0}, 0.1f)) {
                cache.insert(peak_record(x));
                ++(x < 0 ? flat : curved);
            }
    for (float x = 0.2f; x < 1.8f; x += 0.013f)
        EXPECT_NEAR(cache.irradiance({x, 0, 0}, {0, 0, 1}).irradiance.x, peak(x), 0.15 * peak(x)) << "at " << x;
    EXPECT_LT(flat, 8) << "straight light needs no more of them";
    EXPECT_LT(curved, 60);
}

/// Light that sags by an eighth about x = 1, which is less than a third of the cache's error.
double sag(double x) { return 1 - 0.125 * std::exp(-12 * (x - 1) * (x - 1)); }

double worst_in_the_sag(std::int64_t rays) {
    Settings s;
    s.cache_rays = rays;
    s.cache_error = 0.5;
    const CacheOptions options = cache_options(s, 1, 1);
    IrradianceCache cache(static_cast<float>(options.error), 2, static_cast<float>(options.doubt));
    for (const float step : {0.4f, 0.2f, 0.1f, 0.05f, 0.02f, 0.01f})
        for (float x = -2; x < 2; x += step) {
            if (covers(cache, {x, 0, 0}, 0.1f)) continue;
            IrradianceRecord r = record({x, 0, 0}, sag(x), 0.8);
            r.light.variance = 0;
            cache.insert(r);
        }
    double worst = 0;
    for (float x = 0.2f; x < 1.8f; x += 0.013f)
        worst = std::max(worst, std::abs(cache.irradiance({x, 0, 0}, {0, 0, 1}).irradiance.x / sag(x) - 1));
    return worst;
}

/// Where noise is low, what records make wrong together would be all that is left.
TEST(IrradianceCache, FollowsWeakShadowsWhereRaysAreMany) {
    EXPECT_GT(worst_in_the_sag(1000), 0.06) << "or the test shows nothing";
    EXPECT_LT(worst_in_the_sag(64'000), 0.03);
}

/// A dark record of short reach behind a wall, and a bright one before it, whose own reach has the dark one's place but
/// not the other way round.
TEST(IrradianceCache, EndsARecordBeforeOneThatContradictsItWhicheverCameFirst) {
    IrradianceRecord dark = record({0, 0, 0}, 0.1, 0.25), bright = record({0.3f, 0, 0}, 10, 1.5);
    dark.light.variance = bright.light.variance = 0;
    for (const bool dark_first : {true, false}) {
        IrradianceCache cache(0.2f);
        cache.insert(dark_first ? dark : bright);
        cache.insert(dark_first ? bright : dark);
        EXPECT_FLOAT_EQ(cache.reach(dark_first ? 0 : 1), 0.1f);
        EXPECT_LT(cache.reach(dark_first ? 1 : 0), 0.25f) << "dark first: " << dark_first;
        EXPECT_LT(cache.irradiance({0.06f, 0, 0}, {0, 0, 1}).irradiance.x, 0.2) << "dark first: " << dark_first;
    }
}

TEST(IrradianceCache, TakesInWhatMoreRaysFound) {
    // One record of 3/4 and 1/4 of the rays is as good as one of their mean, also where its gradient is held back.
    for (const double distance : {1.0, 0.01}) { // the second: its radius is held up by the bound
        const IrradianceRecord first = record({0, 0, 0}, 4, distance, {1, 0, 0});
        IrradianceRecord more = record({0, 0, 0}, 8, distance, {3, 2, 0}), mean = record({0, 0, 0}, 5, distance);
        more.light.rotation[1] = {0, 4, 0};
        mean.light.translation.fill({1.5f, 0.5f, 0});
        mean.light.rotation[1] = {0, 1, 0};
        IrradianceCache refined(0.2f), expected(0.2f);
        refined.insert(first);
        const float radius = refined.radius(0);
        refined.refine(0, more.light, 0.25);
        EXPECT_EQ(refined.radius(0), radius);
        expected.insert(mean);
        const Vec3 at(0.4f * radius, -0.5f * radius, 0), n = Vec3(0, 0.1f, 1).normalized();
        const Rgb found = refined.irradiance(at, n).irradiance, wanted = expected.irradiance(at, n).irradiance;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 1e-5) << distance << " m, channel " << c;
    }
}

TEST(IrradianceCache, KnowsHowNoisyItsSurroundingsAre) {
    IrradianceCache cache(0.2f);
    const auto insert = [&](float x, double e, double variance) {
        IrradianceRecord r = record({x, 0, 0}, e, 1);
        r.light.variance = variance;
        cache.insert(r);
    };
    insert(0, 10, 100);
    insert(0.15f, 10, 4);
    insert(0.3f, 10, 16);
    insert(5, 10, 1e9); // alone
    insert(7, 1e-9, 1); // two that are dark
    insert(7.2f, 1e-9, 1);
    const std::vector<double> noise = cache.relative_noise();
    ASSERT_EQ(noise.size(), 6u);
    EXPECT_NEAR(noise[1], std::sqrt((100 + 16) / 200.0), 0.003) << "of both others";
    EXPECT_NEAR(noise[0], std::sqrt((4 + 16) / 200.0), 0.003) << "not its own";
    EXPECT_GT(noise[3], 100) << "the mean of all";
    EXPECT_LT(noise[4], 2) << "what is dark needs no rays";
}

TEST(IrradianceCache, KnowsItsNoiseAsAWhole) {
    IrradianceCache cache(0.2f);
    EXPECT_EQ(cache.noise(), 0);
    for (int i = 0; i < 4; ++i) {
        IrradianceRecord r = record({static_cast<float>(i), 0, 0}, i, 1);
        r.light.variance = i == 3 ? 12 : 0.5;
        cache.insert(r);
    }
    EXPECT_NEAR(cache.noise(), std::sqrt((3 * 0.5 + 12) / (1 + 4 + 9)), 1e-6);
}

TEST(IrradianceCache, RecordsThatContradictEachOtherEndAtTheWallBetweenThem) {
    constexpr float kWall = 0.1f, kLeast = 1; // [m] from the bright record; of both, which are 0.5 m apart
    // What the two say at x with a wall, or without.
    const auto light_at = [&](float x, double dark, bool parted) {
        IrradianceCache cache(0.3f);
        const WallBetween wall = [&](const Vec3& from, const Vec3& /*normal*/, const Vec3& to) {
            const Vec3 n(to.x < from.x ? -1.0f : 1.0f, 0, 0);
            return parted ? std::optional(Wall{n, std::abs(from.x - kWall)}) : std::nullopt;
        };
        for (const auto& [at, light] : {std::pair(0.0f, 10.0), {0.5f, dark}}) {
            IrradianceRecord r = record({at, 0, 0}, light, 10);
            r.light.variance = 0;
            r.min_radius = r.min_radius_by_light = kLeast;
            cache.insert(r, wall);
        }
        return cache.irradiance({x, 0, 0}, {0, 0, 1}).irradiance.x;
    };
    EXPECT_DOUBLE_EQ(light_at(0.11f, 1, true), 1);
    EXPECT_DOUBLE_EQ(light_at(0.09f, 1, true), 10);
    EXPECT_DOUBLE_EQ(light_at(-0.4f, 1, true), 10) << "beside the wall it goes on";
    EXPECT_GT(light_at(0.11f, 1, false), 2) << "in sight of each other the lower bound holds";
    EXPECT_GT(light_at(0.11f, 9.9, true), 9.905) << "where light is the same, a wall parts nothing";
}

TEST(IrradianceCache, ASecondWallEndsARecordAllAround) {
    IrradianceCache cache(0.3f);
    const WallBetween wall = [](const Vec3& from, const Vec3& /*normal*/, const Vec3& to) {
        const Vec3 d = to - from; // half way, across the line of sight
        return std::optional(Wall{d.normalized(), d.length() / 2});
    };
    const auto insert = [&](const Vec3& p, double light) {
        IrradianceRecord r = record(p, light, 10);
        r.light.variance = 0;
        r.min_radius = r.min_radius_by_light = 1;
        cache.insert(r, wall);
    };
    insert({0, 0, 0}, 10);
    insert({0.4f, 0, 0}, 1);
    EXPECT_GE(cache.reach(0), 1);
    insert({0, 0.3f, 0}, 1);
    EXPECT_FLOAT_EQ(cache.reach(0), 0.15f);
}

TEST(IrradianceCache, DoesNotTakeNoiseForLight) {
    Rng rng(2, StreamPurpose::test, 0);
    const auto finest = [&](double told) {
        IrradianceCache cache(0.3f);
        for (int i = 0; i < 100; ++i) {
            IrradianceRecord r = record({0.3f * static_cast<float>(i), 0, 0}, 10 + 10 * (rng.next() - 0.5), 1);
            r.light.variance = told;
            cache.insert(r);
        }
        float least = kMax;
        for (std::size_t i = 0; i < cache.size(); ++i) least = std::min(least, cache.radius(i));
        return least;
    };
    EXPECT_LT(finest(0), 0.25f);
    EXPECT_FLOAT_EQ(finest(25), 0.3f);
}

} // namespace
} // namespace keyhole
