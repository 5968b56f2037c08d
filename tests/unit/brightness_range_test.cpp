// Pictures of lamps of any brightness: those of path space sum up splats in fixed point.
#include "methods/method.h"
#include "methods/render.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

double mean_of_picture(const char* method, double radiance) {
    test::SceneMaker m;
    m.room({0, 0, 0}, {2, 2, 2}, make_diffuse(Rgb(0.5)))
        .rectangle({0.5f, 1.9f, 0.5f}, {1, 0, 0}, {0, 0, 1}, make_diffuse(Rgb(0.0)), Rgb(radiance))
        .camera({1, 1, 1.9f}, {1, 0.5f, 0}, 60)
        .window(16, 12);
    const auto scene = m.build();
    Settings s;
    s.method = &method_named(method);
    s.spp = 64;
    s.mutations = 20'000;
    s.brightness_samples = 20'000;
    const Image beauty = render(*scene, s, {}).picture.layers.at("beauty");
    double sum = 0;
    for (const float x : beauty.data) sum += x;
    return sum / static_cast<double>(beauty.data.size());
}

class BrightnessRange : public testing::TestWithParam<const char*> {};

TEST_P(BrightnessRange, IsThatOfTheScene) {
    const double usual = mean_of_picture(GetParam(), 1);
    ASSERT_GT(usual, 0);
    for (const double radiance : {0x1p-30, 0x1p40})
        EXPECT_NEAR(mean_of_picture(GetParam(), radiance) / radiance, usual, 1e-3 * usual);
}

INSTANTIATE_TEST_SUITE_P(Methods, BrightnessRange, testing::Values("path", "bdpt", "mlt", "pssmlt", "mmlt", "rjmlt"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
