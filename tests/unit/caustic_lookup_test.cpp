// Lookups in the caustic map at visible points.
#include "gather/gather_rays.h"
#include "gather/visible_point.h"
#include "photon_support.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using namespace photon_test;

TEST(CausticLookup, IsRightOnAverageWhereItIsDoneByChance) {
    const Rectangle floor{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    SceneDescription d;
    d.shapes.push_back(shape_of(floor, 300));
    d.shapes.push_back(shape_of({{0.5f, 0, 0.4f}, {0, 0.3f, 0}, {0, 0, 0.6f}}));
    for (Shape& shape : d.shapes) shape.material = make_diffuse(Rgb(0.5));
    d.camera = {.origin = {0.5f, 2, 0.5f}, .right = {1, 0, 0}, .up = {0, 0, -1}, .forward = {0, -1, 0}};
    d.window.width = d.window.height = 8;
    const auto scene = std::make_unique<Scene>(std::move(d));
    const SurfacePatches patches(*scene);
    Rng rng = make_rng(1);
    const PilotedMap map({.pilots = throw_photons(floor, 500, rng), .main_photons = throw_photons(floor, 2000, rng)});
    const PilotSurroundings surroundings(map.pilots(), patches, 40, 0.3f, 1);
    const GatherRays rays(*scene, {.caustic = &map, .caustic_surroundings = &surroundings, .patches = &patches},
                          {.nearest = 40, .max_radius = 0.3f, .caustic_radius = 0.3f}, 5);
    for (const Vec2& image : {Vec2(0.5f, 0.5f), Vec2(0.72f, 0.55f)}) {
        const auto seen = visible_point(rays, image, rng);
        ASSERT_TRUE(seen);
        const double whole = luminance(rays.caustic(seen->vertex, seen->back, 0, rng));
        ASSERT_GT(whole, 0);
        ASSERT_EQ(luminance(rays.caustic(seen->vertex, seen->back, 0, rng)), whole) << "the greater part is looked at";
        for (const double besides : {20 * whole, 1e6 * whole}) {
            RunningStats found;
            for (int i = 0; i < 4000; ++i) found.add(luminance(rays.caustic(seen->vertex, seen->back, besides, rng)));
            EXPECT_TRUE(test::has_mean(found, whole));
            EXPECT_GT(found.variance(), 0) << "it was always looked at";
        }
    }
}

} // namespace
} // namespace keyhole
