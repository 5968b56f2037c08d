#include "gather/irradiance_cache.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr float kMin = 0.01f, kMax = 10;

IrradianceRecord record(const Vec3& p, double e, double distance, const Vec3& slope = Vec3(0.0f),
                        const Vec3& n = {0, 0, 1}) {
    IrradianceRecord r{p, n, {}, kMin, kMax};
    r.light.irradiance = Rgb(e);
    r.light.translation = {slope, slope, slope};
    r.light.distance = distance;
    return r;
}

TEST(IrradianceCache, IsExactAtARecordAndSilentBeyondItsReach) {
    IrradianceCache cache(0.2f);
    EXPECT_EQ(cache.irradiance({0, 0, 0}, {0, 0, 1}).weight, 0);
    cache.insert(record({1, 2, 3}, 5, 1));
    const auto there = cache.irradiance({1, 2, 3}, {0, 0, 1});
    EXPECT_DOUBLE_EQ(there.irradiance.y, 5);
    EXPECT_DOUBLE_EQ(there.weight, 1);
    EXPECT_GT(cache.irradiance({1.19f, 2, 3}, {0, 0, 1}).weight, 0);
    EXPECT_EQ(cache.irradiance({1.21f, 2, 3}, {0, 0, 1}).weight, 0);
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
    EXPECT_GT(cache.irradiance({0.2f, 0, 0}, {0, 0, 1}).weight, 0);
    EXPECT_EQ(cache.irradiance({0.2f, 0, 0}, {0, 0, -1}).weight, 0) << "the other side of a sheet";
    EXPECT_EQ(cache.irradiance({0.2f, 0, 0}, {1, 0, 0}).weight, 0) << "another wall";
    EXPECT_EQ(cache.irradiance({0.2f, 0, 0.2f}, {0, 0, 1}).weight, 0) << "the next step of a stair";
    EXPECT_EQ(cache.irradiance({0.2f, 0, -0.2f}, {0, 0, 1}).weight, 0) << "behind the record";
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

TEST(IrradianceCache, ReachEndsWhereTheGradientStopsHolding) {
    IrradianceCache cache(0.2f);
    cache.insert(record({0, 0, 0}, 1, 5, {1, 0, 0})); // changes by its own size within 1 m
    EXPECT_FLOAT_EQ(cache.radius(0), 0.2f);
}

} // namespace
} // namespace keyhole
