// Closed box of albedo rho whose walls emit 1 W/(m^2 sr): radiance is 1 / (1 - rho) everywhere, by every method.
#include "render/render.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

class Furnace_HasItsClosedForm : public testing::TestWithParam<const char*> {};

TEST_P(Furnace_HasItsClosedForm, InEveryBlock) {
    constexpr double rho = 0.5;
    const auto scene = test::furnace(rho);
    Settings settings;
    settings.method = GetParam();
    settings.spp = 16;
    settings.mutations = 200'000;
    settings.photons = 100'000;
    settings.importons = 200'000;
    settings.brightness_samples = 200'000;
    const Picture picture = render(*scene, settings, {}).picture;
    const Image& image = picture.layers.at("beauty");
    constexpr int block = 8;
    for (int y = 0; y < image.height; y += block) {
        for (int x = 0; x < image.width; x += block) {
            double sum = 0;
            for (int i = 0; i < block * block; ++i) sum += image.at(x + i % block, y + i / block)[1];
            EXPECT_NEAR(sum / (block * block), 1 / (1 - rho), 0.03 / (1 - rho)) << "block at " << x << ", " << y;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Furnace_HasItsClosedForm, testing::Values("mps", "path"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
