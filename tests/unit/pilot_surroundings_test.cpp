// Areas of lookups that are taken from pilot photons near by.
#include "photonmap/pilot_surroundings.h"

#include "photon_support.h"
#include "support/test_scenes.h"

namespace keyhole {
namespace {

using namespace photon_test;

constexpr Vec3 kUp(0, 1, 0);
constexpr int kNearest = 60;
constexpr float kReach = 0.3f;

/// A floor of 1 x 1 m, and a wall across it at x = 0.5 m.
std::unique_ptr<Scene> floor_with_wall() {
    test::SceneMaker m;
    m.rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, make_diffuse(Rgb(0.5)));
    m.rectangle({0.5f, 0, 0}, {0, 1, 0}, {0, 0, 1}, make_diffuse(Rgb(0.5)));
    return m.camera({0.5f, 0.5f, 3}, {0.5f, 0, 0}, 40).window(8, 8).build();
}

PhotonSet photons_on_floor(std::uint64_t index) {
    Rng rng = make_rng(index);
    PhotonSet photons;
    const Rectangle before{{0.5f, 0, 0}, {0, 0, 1}, {0.5f, 0, 0}}, behind{{0, 0, 0}, {0, 0, 1}, {0.5f, 0, 0}};
    for (const auto& [part, count] : {std::pair{before, 900}, std::pair{behind, 300}}) {
        throw_photons(part, count, rng, photons.main_photons);
        throw_photons(part, count / (kPilotEvery - 1), rng, photons.pilots);
    }
    return photons;
}

/// Density that lookups along a line at `x` find, of what they see [1/m^2].
RunningStats densities(const Scene& scene, float x) {
    const SurfacePatches patches(scene);
    RunningStats found;
    for (std::uint64_t i = 0; i < 200; ++i) {
        const PilotedMap map(photons_on_floor(i));
        const PilotSurroundings surroundings(map, patches, kNearest, kReach, 1);
        RunningStats along; // lookups of one map share photons
        for (float z = 0.05f; z < 1; z += 0.1f) {
            const SurfaceRegion region{{x, 0, z}, kUp};
            const PilotedRegion piloted = piloted_region(map.pilots(), {region, kReach, kNearest});
            const Surroundings around = surroundings.around(region, piloted);
            EXPECT_GT(around.area, 0);
            const auto one = [](const Photon&) { return 1.0; };
            along.add(around.partly_occluded
                          ? estimate_density(map.main_photons(), region, piloted.radius, around.area,
                                             weight_in_sight(scene, region, piloted.radius, one))
                                .value.x
                          : estimate_density(map.main_photons(), region, piloted.radius, around.area, one).value.x);
        }
        found.add(along.mean());
    }
    return found;
}

TEST(PilotSurroundings, TellTheDensityAtEdgesAndWalls) {
    const auto scene = floor_with_wall();
    // In the open, at the floor's end, near it, and close to the wall.
    for (const float x : {0.75f, 0.99f, 0.93f}) {
        SCOPED_TRACE(x);
        EXPECT_NEAR(densities(*scene, x).mean(), 1800, 0.05 * 1800);
    }
    for (const float x : {0.51f, 0.56f}) {
        SCOPED_TRACE(x);
        EXPECT_NEAR(densities(*scene, x).mean(), 1800, 0.1 * 1800);
    }
}

/// All pilot photons that are near lie behind the wall, and too far from it to be partly_occluded themselves.
TEST(PilotSurroundings, BeforeAWallAreNotThoseOfPhotonsBehindIt) {
    const auto scene = floor_with_wall();
    const SurfacePatches patches(*scene);
    Rng rng = make_rng(1);
    PhotonSet photons;
    const Rectangle bright{{0.6f, 0, 0}, {0, 0, 1}, {0.4f, 0, 0}};
    throw_photons(bright, 4000, rng, photons.main_photons);
    throw_photons(bright, 4000 / (kPilotEvery - 1), rng, photons.pilots);
    const PilotedMap map(std::move(photons));
    const PilotSurroundings surroundings(map, patches, kNearest, kReach, 1);
    for (float z = 0.05f; z < 1; z += 0.1f) {
        const SurfaceRegion region{{0.45f, 0, z}, kUp};
        const PilotedRegion piloted = piloted_region(map.pilots(), {region, kReach, kNearest});
        ASSERT_TRUE(piloted.nearest);
        EXPECT_TRUE(surroundings.partly_occluded(region, piloted));
        EXPECT_TRUE(surroundings.around(region, piloted).partly_occluded);
    }
}

TEST(PilotSurroundings, DoNotDependOnWhoAsksFirst) {
    const auto scene = floor_with_wall();
    const SurfacePatches patches(*scene);
    const PilotedMap map(photons_on_floor(1));
    const PilotSurroundings up(map, patches, kNearest, kReach, 1);
    const PilotSurroundings down(map, patches, kNearest, kReach, 1);
    const auto area = [&](const PilotSurroundings& surroundings, int i) {
        const SurfaceRegion region{{0.01f * static_cast<float>(i), 0, 0.5f}, kUp};
        return surroundings.around(region, piloted_region(map.pilots(), {region, kReach, kNearest})).area;
    };
    constexpr int kPlaces = 100;
    std::vector<double> first(kPlaces), again(kPlaces);
    for (int i = 0; i < kPlaces; ++i) first[static_cast<std::size_t>(i)] = area(up, i);
    for (int i = kPlaces; i-- > 0;) again[static_cast<std::size_t>(i)] = area(down, i);
    EXPECT_EQ(first, again);
    for (int i = 0; i < kPlaces; ++i)
        EXPECT_EQ(area(up, i), first[static_cast<std::size_t>(i)]) << "remembered wrongly";
}

} // namespace
} // namespace keyhole
