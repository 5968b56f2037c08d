// Density estimates beside walls that stand on a surface.
#include "photon_support.h"
#include "photonmap/irradiance/irradiance_map.h"
#include "photonmap/surface/density_in_sight.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using namespace photon_test;

constexpr Vec3 kUp(0, 1, 0);
constexpr float kRadius = 0.2f;
const Rectangle kFloor{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};

/// A floor, and a wall across it at `x`.
std::unique_ptr<Scene> floor_with_wall(float x) {
    test::SceneMaker m;
    m.rectangle(kFloor.corner, kFloor.u, kFloor.v, make_diffuse(Rgb(0.5)));
    m.rectangle({x, 0, 0}, {0, 1, 0}, {0, 0, 1}, make_diffuse(Rgb(0.5)));
    return m.camera({0.5f, 0.5f, 3}, {0.5f, 0, 0}, 40).window(8, 8).build();
}

double one(const Photon&) { return 1; }

/// Estimates at `position` of the density of photons that a floor with a wall at `wall` holds: 300 on its unit square,
/// and ten times as many beyond the wall.
RunningStats estimates(const Scene& scene, float wall, const Vec3& position) {
    const SurfacePatches patches(scene);
    RunningStats stats;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        Rng rng = make_rng(i);
        std::vector<Photon> photons =
            throw_photons({{wall, 0, 0}, {0, 0, 1}, {1 - wall, 0, 0}}, static_cast<int>(300 * (1 - wall)), rng);
        if (wall > 0) throw_photons({{0, 0, 0}, {0, 0, 1}, {wall, 0, 0}}, static_cast<int>(3000 * wall), rng, photons);
        const PhotonMap map(std::move(photons));
        const DensityEstimate e = estimate_density_in_sight(scene, map, {position, kUp}, kRadius, patches, one);
        EXPECT_TRUE(e.obstructed);
        stats.add(e.value.x);
    }
    return stats;
}

TEST(Sight, CountsNoAreaBeyondTheEndOfAFloor) {
    const auto scene = floor_with_wall(0);
    for (const float x : {0.001f, 0.05f, 0.15f}) {
        SCOPED_TRACE(x);
        expect_mean(estimates(*scene, 0, {x, 0, 0.5f}), 300);
        expect_mean(estimates(*scene, 0, {x, 0, 0.001f}), 300); // in the corner
    }
}

TEST(Sight, HidesWhatLiesBeyondAWall) {
    const auto scene = floor_with_wall(0.5f);
    for (const float x : {0.51f, 0.56f, 0.64f}) {
        SCOPED_TRACE(x);
        const RunningStats stats = estimates(*scene, 0.5f, {x, 0, 0.5f});
        // The share in sight is that of 16 places.
        EXPECT_NEAR(stats.mean(), 300, 300 * 0.12);
    }
}

TEST(Sight, TakesNoAnswerFromBeyondAWall) {
    // Close behind a wall photons are dense, and regions so small that the wall stands in none of them; before it they
    // are rare. The nearest estimate is one of the other side.
    const auto scene = floor_with_wall(0.5f);
    const SurfacePatches patches(*scene);
    Rng rng = make_rng(7);
    const Rectangle behind{{0.44f, 0, 0}, {0, 0, 1}, {0.04f, 0, 0}}, before{{0.56f, 0, 0}, {0, 0, 1}, {0.4f, 0, 0}};
    const auto both = [&](int dense, int rare) {
        std::vector<Photon> photons = throw_photons(behind, dense, rng);
        throw_photons(before, rare, rng, photons);
        return PhotonMap(std::move(photons));
    };
    const PhotonMap pilots = both(2000, 40), main_photons = both(20'000, 400);
    const IrradianceMap map(pilots, main_photons,
                            {.k = 20, .max_radius = 0.2f, .patches = &patches, .scene = scene.get()}, {});
    for (float z = 0.1f; z < 0.95f; z += 0.1f) {
        const auto answer = map.irradiance({0.505f, 0, z}, kUp);
        EXPECT_TRUE(answer.known) << z;
        EXPECT_LT(answer.irradiance.x, 5000) << z; // it is 1000 here, and 500,000 there
    }
}

TEST(Sight, TakesNoAnswerFromBeyondAWallCloseBy) {
    // Dense places on both sides of a wall that stands in the regions of all of them. The nearest place is often one of
    // the other side, at a small part of its region's radius.
    const auto scene = floor_with_wall(0.5f);
    const SurfacePatches patches(*scene);
    Rng rng = make_rng(8);
    const Rectangle dim{{0.5f, 0, 0}, {0, 0, 1}, {0.5f, 0, 0}}, bright{{0, 0, 0}, {0, 0, 1}, {0.5f, 0, 0}};
    std::vector<Photon> places = throw_photons(dim, 4000, rng), main_photons = throw_photons(dim, 500, rng);
    throw_photons(bright, 4000, rng, places);
    throw_photons(bright, 50'000, rng, main_photons);
    const PhotonMap pilots(std::move(places)), map_of_main(std::move(main_photons));
    const IrradianceMap map(pilots, map_of_main,
                            {.k = 1000, .max_radius = 0.2f, .patches = &patches, .scene = scene.get()}, {});
    int asked = 0, foreign = 0;
    for (float x = 0.5005f; x < 0.53f; x += 0.001f)
        for (float z = 0.11f; z < 0.9f; z += 0.02f) {
            const auto answer = map.irradiance({x, 0, z}, kUp);
            ++asked;
            foreign += answer.known && pilots[answer.place].position().x < 0.5f ? 1 : 0;
        }
    EXPECT_GT(asked, 1000);
    EXPECT_EQ(foreign, 0);
}

} // namespace
} // namespace keyhole
