// Where filling an irradiance cache leaves records.
#include "gather/fill_cache.h"

#include "photonmap/surface/sight.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// A floor that a low thin wall parts, seen from above: records reach much farther than the wall is high.
std::unique_ptr<Scene> parted_floor() {
    const auto white = make_diffuse(Rgb(0.5));
    test::SceneMaker m;
    m.rectangle({0, 0, 0}, {0, 0, 4}, {4, 0, 0}, white)
        .rectangle({2, 0, 0}, {0, 0.2f, 0}, {0, 0, 4}, white)
        .rectangle({1.5f, 6, 1.5f}, {1, 0, 0}, {0, 0, 1}, white, Rgb(1.0))
        .camera({2, 5, 3}, {2, 0, 2}, 50)
        .window(48, 48);
    return m.build();
}

TEST(FillCache, LeavesRecordsInSightOnEitherSideOfAWall) {
    constexpr float kBeside = 0.15f; // [m], less than a record's least reach
    const auto scene = parted_floor();
    const GatherRays rays(*scene, {}, {.max_radius = 0.1f, .caustic_radius = 0.1f}, 8);
    const CacheOptions options{.error = 0.5, .rays = 64, .min_radius = 6, .min_radius_by_light = 6};
    const HotSpots spots(rays, 1 << 11, 1, {});
    const IrradianceCache cache = fill_cache(rays, spots, options, {});
    const Vec3 up(0, 1, 0);
    int points = 0, covered = 0;
    Rng rng(5, StreamPurpose::test, 0);
    while (points < 2000) {
        const auto c = visible_point(rays, {static_cast<float>(rng.next()), static_cast<float>(rng.next())}, rng);
        if (!c || c->vertex.point.p.y > 1e-4f || std::abs(c->vertex.point.p.x - 2) > kBeside) continue;
        const Vec3 p = c->vertex.point.p;
        const auto sees = [&](const Vec3& record) {
            return in_sight(*scene, {p, up}, 0.05f * (record - p).length(), record);
        };
        ++points;
        covered += cache.covers(p, up, 0.01f, sees) ? 1 : 0;
    }
    EXPECT_GT(covered, 0.995 * points) << "0.986 where records cover what they don't see";
    EXPECT_LT(cache.size(), 100u);
}

/// Records that few rays would do for are left to gather rays of the pixels.
TEST(FillCache, LeavesOutRecordsThatAreNotWorthTheirRays) {
    const auto scene = parted_floor();
    const GatherRays rays(*scene, {}, {.max_radius = 0.1f, .caustic_radius = 0.1f}, 8);
    const HotSpots spots(rays, 1 << 11, 1, {});
    const auto records = [&](double rays_for_pixel) {
        const CacheOptions options{.error = 0.1, .rays = 64, .rays_for_pixel = rays_for_pixel};
        return fill_cache(rays, spots, options, {}).size();
    };
    const std::size_t all = records(64), half = records(17), few = records(0.1);
    EXPECT_EQ(all, records(std::numeric_limits<double>::infinity()));
    EXPECT_EQ(all, records(41)) << "40 rays are a record";
    EXPECT_LT(records(39), all);
    EXPECT_LT(half, all);
    EXPECT_LT(few, half);
    EXPECT_LE(few, 9u) << "16 pixels apart";
    EXPECT_GT(few, 0u);
}

/// Records of a floor lie as far apart as its walls have it; where they may lie at each pixel, all pixels have some.
TEST(FillCache, TellsHowRecordsGrowWithPixels) {
    const auto scene = parted_floor();
    const GatherRays rays(*scene, {}, {.max_radius = 0.1f, .caustic_radius = 0.1f}, 8);
    const auto growth = [&](const CacheOptions& options) { return fill_cache(rays, {}, options, {}).growth(); };
    const double few = growth({.error = 0.5, .rays = 64, .min_radius = 20, .min_radius_by_light = 20});
    const double many = growth({.error = 0.01, .rays = 64, .min_radius = 0.5, .min_radius_by_light = 0.5});
    EXPECT_LT(few, 0.3);
    EXPECT_GT(many, 0.7);
    EXPECT_LE(many, 1);
}

} // namespace
} // namespace keyhole
