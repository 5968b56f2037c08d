// Lookups in the caustic map at visible points.
#include "gather/gather_rays.h"
#include "gather/visible_point.h"
#include "photon_support.h"
#include "sampling/paths/walk.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <array>

namespace keyhole {
namespace {

using namespace photon_test;

const Rectangle kFloor{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};

/// That floor, so finely cut that areas take rays, with a wall on it, seen from above.
std::unique_ptr<Scene> fine_floor() {
    SceneDescription d;
    d.shapes.push_back(shape_of(kFloor, 300));
    d.shapes.push_back(shape_of({{0.5f, 0, 0.4f}, {0, 0.3f, 0}, {0, 0, 0.6f}}));
    for (Shape& shape : d.shapes) shape.material = make_diffuse(Rgb(0.5));
    d.camera = {.origin = {0.5f, 2, 0.5f}, .right = {1, 0, 0}, .up = {0, 0, -1}, .forward = {0, -1, 0}};
    d.window.width = d.window.height = 8;
    return std::make_unique<Scene>(std::move(d));
}

TEST(CausticLookup, IsRightOnAverageWhereItIsDoneByChance) {
    const auto scene = fine_floor();
    const SurfacePatches patches(*scene);
    Rng rng = make_rng(1);
    const PilotedMap map({.pilots = throw_photons(kFloor, 500, rng), .main_photons = throw_photons(kFloor, 2000, rng)});
    const PilotSurroundings surroundings(map, patches, 40, 0.3f, 1);
    const GatherRays rays(*scene, {.caustic = &map, .caustic_surroundings = &surroundings, .patches = &patches},
                          {.nearest = 40, .max_radius = 0.3f, .caustic_radius = 0.3f}, 5);
    for (const Vec2& image : {Vec2(0.5f, 0.5f), Vec2(0.72f, 0.55f)}) {
        const auto seen = visible_point(rays, image, rng);
        ASSERT_TRUE(seen);
        const double whole = luminance(rays.caustic(seen->vertex, seen->back, 0, 1, rng));
        ASSERT_GT(whole, 0);
        ASSERT_EQ(luminance(rays.caustic(seen->vertex, seen->back, 0, 1, rng)), whole)
            << "the greater part is looked at";
        for (const double besides : {20 * whole, 1e6 * whole}) {
            RunningStats found;
            for (int i = 0; i < 4000; ++i)
                found.add(luminance(rays.caustic(seen->vertex, seen->back, besides, 1, rng)));
            EXPECT_TRUE(test::has_mean(found, whole));
            EXPECT_GT(found.variance(), 0) << "it was always looked at";
        }
    }
}

/// Irradiance of 20 kW/m^2 everywhere, by photons of 1 W. Close to the wall a part of the region is out of sight, and
/// few photons are asked for the rest.
TEST(CausticLookup, TellsWhatFallsOnTheFloorBesideAWall) {
    const auto scene = fine_floor();
    const SurfacePatches patches(*scene);
    const std::array places{0.2512f, 0.7512f, 0.5112f, 0.5312f};
    std::array<RunningStats, places.size()> found;
    for (std::uint64_t i = 0; i < 40; ++i) {
        Rng rng = make_rng(i);
        const PilotedMap map(
            {.pilots = throw_photons(kFloor, 5000, rng), .main_photons = throw_photons(kFloor, 20'000, rng)});
        const PilotSurroundings surroundings(map, patches, 200, 0.3f, 1);
        const GatherRays rays(*scene, {.caustic = &map, .caustic_surroundings = &surroundings, .patches = &patches},
                              {.nearest = 200, .max_radius = 0.3f, .caustic_radius = 0.3f}, 5);
        for (std::size_t k = 0; k < places.size(); ++k) {
            RunningStats of_map;
            for (float z = 0.5007f; z < 0.95f; z += 0.02f) {
                SurfacePoint above;
                above.site = Site::point;
                above.p = {places[k], 1, z};
                const auto seen = next_vertex(*scene, above, {0, -1, 0});
                of_map.add(luminance(rays.caustic(seen.value(), {0, 1, 0}, 0, 1, rng)));
            }
            found[k].add(of_map.mean());
        }
    }
    const double expected = 0.5 / kPi * 20'000;
    for (std::size_t k = 0; k < places.size(); ++k) {
        SCOPED_TRACE(places[k]);
        EXPECT_NEAR(found[k].mean(), expected, 0.04 * expected + 3 * found[k].standard_error());
        EXPECT_LT(found[k].standard_error(), 0.02 * expected);
    }
}

/// Light that lookups find on the floor [W], by a lattice of points seen from above: what it reflects over 0.5 / pi.
double power_found(const Scene& scene, const GatherRays& rays) {
    const Vec3 up(0, 1, 0);
    Rng rng = make_rng(1);
    constexpr int kPoints = 200; // across the floor
    double sum = 0;
    for (int i = 0; i < kPoints * kPoints; ++i) {
        SurfacePoint above;
        above.site = Site::point;
        above.p = {(static_cast<float>(i % kPoints) + 0.5f) / kPoints, 1,
                   (static_cast<float>(i / kPoints) + 0.5f) / kPoints};
        const auto seen = next_vertex(scene, above, -up);
        if (std::abs(seen->point.ng.y) < 0.5f) continue; // the wall's edge
        sum += luminance(rays.caustic(seen.value(), up, 0, 1, rng)) / (kPoints * kPoints);
    }
    return sum / (0.5 / kPi);
}

/// Spots as a ball of small mirrors throws them, each of half as many photons again as a lookup asks for. By lookups
/// that grow in the dark until they have so many, the floor between them had several times the power of the spots.
TEST(CausticLookup, FindsNoMoreThanThePowerOfManySpots) {
    const auto scene = fine_floor();
    const SurfacePatches patches(*scene);
    const Vec3 up(0, 1, 0);
    Rng rng = make_rng(1);
    PhotonSet photons;
    constexpr int kPhotons = 90, kNearest = 60;
    int spots = 0;
    for (const float x : {0.125f, 0.375f, 0.625f, 0.875f})
        for (const float z : {0.15f, 0.4f, 0.65f, 0.9f}) {
            ++spots;
            for (int i = 0; i < kPhotons + kPhotons / (kPilotEvery - 1); ++i) {
                const auto [u, v] = rng.next_point();
                const auto r = static_cast<float>(0.02 * std::sqrt(u)), angle = static_cast<float>(2 * kPi * v);
                (i < kPhotons ? photons.main_photons : photons.pilots)
                    .emplace_back(Vec3(x + r * std::cos(angle), 0, z + r * std::sin(angle)), up, up, Rgb(1.0));
            }
        }
    const PilotedMap map(std::move(photons));
    const PilotSurroundings surroundings(map, patches, kNearest, 0.3f, 1);
    const GatherRays rays(*scene, {.caustic = &map, .caustic_surroundings = &surroundings, .patches = &patches},
                          {.nearest = kNearest, .max_radius = 0.3f, .caustic_radius = 0.3f}, 5);
    const double all = kPhotons * spots;
    EXPECT_NEAR(power_found(*scene, rays), all, 0.05 * all);
}

/// Its region is four times as wide as that of a lookup, and ends before the floor and the wall do.
TEST(CausticLookup, FindsAllThePowerOfAPhotonThatStandsAlone) {
    const auto scene = fine_floor();
    const SurfacePatches patches(*scene);
    const Vec3 up(0, 1, 0);
    PilotedMap map({.pilots = {}, .main_photons = {Photon({0.25f, 0, 0.5f}, up, up, Rgb(3.0))}});
    const OutlyingPhotons outlying(map, 40, 0.05f, 1, &patches);
    ASSERT_EQ(outlying.size(), 1u);
    const PilotSurroundings surroundings(map, patches, 40, 0.05f, 1);
    const GatherRays rays(
        *scene, {.caustic = &map, .caustic_surroundings = &surroundings, .outlying = &outlying, .patches = &patches},
        {.nearest = 40, .max_radius = 0.05f, .caustic_radius = 0.05f}, 5);
    EXPECT_NEAR(power_found(*scene, rays), 3, 0.06);
}

} // namespace
} // namespace keyhole
