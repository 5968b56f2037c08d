// An eye that sees along parallels: paths from the eye, from the light and from photons show the same picture.
#include "methods/method.h"
#include "methods/render.h"
#include "support/same_light.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

Settings base() {
    Settings s = test::settings_from("max_depth=24 brightness_samples=600k importons=30k mutations=800k "
                                     "light_paths=120k photons=60k chains=200 cache_rays=200");
    s.spp = 16; // the lamp in the mirrors is bright and small
    return s;
}

TEST(ParallelSight_Light, IsTheSameByEveryMethod) {
    // Both ends: what few paths from the eye alone find of caustics is noise.
    Settings paths = base();
    paths.method = &methods::bdpt;
    paths.spp = 300;
    std::vector<Settings> others = test::by_methods(base(), {"path", "mlt", "mmlt", "pm", "ipm", "mps"});
    others[0].spp = 100;
    test::expect_same_light(*test::parallel_sight_box(), paths, others, 4);
}

TEST(ParallelSightThroughALens_Light, IsTheSameFromBothEnds) {
    Settings paths = base();
    paths.method = &methods::bdpt;
    paths.spp = 100;
    std::vector<Settings> others = test::by_methods(base(), {"path", "mmlt", "ipm"});
    others[0].spp = 100;
    test::expect_same_light(*test::parallel_sight_box(0.05f), paths, others, 2);
}

/// The room's rear wall is 3.9 m from the plane, behind what a pinhole 1800 m away measures.
TEST(ParallelSight_Depth, IsCountedFromItsPlane) {
    const auto scene = test::parallel_sight_box();
    scene->set_window({12, 8, 0});
    Settings rest = base();
    rest.spp = 4;
    for (const Settings& s : test::by_methods(rest, {"path", "ipm"})) {
        const RenderResult result = render(*scene, s, {});
        EXPECT_NEAR(result.picture.layers.at("depth").at(5, 1)[0], 3.9, 0.02) << name_of(*s.method);
    }
}

} // namespace
} // namespace keyhole
