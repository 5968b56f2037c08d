#include "gather/direct_irradiance.h"

#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// A lamp of 0.2 x 0.2 m, one metre above the middle of a floor, and perhaps a shade between them.
std::unique_ptr<Scene> lamp(bool shaded) {
    test::SceneMaker m;
    const auto black = make_diffuse(Rgb(0.0));
    m.rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, make_diffuse(Rgb(0.5)))
        .rectangle({-0.1f, 1, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}, black, Rgb(10.0));
    if (shaded) m.rectangle({-0.3f, 0.5f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, black);
    return m.build();
}

DirectIrradiance light_of_the_middle(const Scene& scene, int samples) {
    SurfacePoint above;
    above.p = {0, 0.3f, 0};
    above.site = Site::point;
    const auto floor = scene.trace(above, {0, -1, 0});
    Rng rng(1, StreamPurpose::test, 0);
    return direct_irradiance(scene, *floor, floor->material->bsdf(*floor), {0, 1, 0}, {samples}, rng);
}

TEST(DirectIrradiance, IsTheIrradianceUnderARectangle) {
    // Lambert's formula for a square of half side a at distance 1, over its middle.
    const double a = 0.1, s = std::sqrt(1 + a * a);
    const double exact = 10 * 4 * (a / s) * std::atan(a / s);
    EXPECT_NEAR(light_of_the_middle(*lamp(false), 4000).irradiance.x, exact, 0.01 * exact);
}

TEST(DirectIrradiance, ReachesAQuarterOfTheDistance) {
    EXPECT_NEAR(light_of_the_middle(*lamp(false), 100).reach, 0.25f, 0.005f);
}

TEST(DirectIrradiance, IsDarkInTheShadeAndKnowsHowFarItIs) {
    const DirectIrradiance shaded = light_of_the_middle(*lamp(true), 100);
    EXPECT_EQ(shaded.irradiance.x, 0);
    EXPECT_NEAR(shaded.reach, 0.25f, 0.005f);
}

} // namespace
} // namespace keyhole
