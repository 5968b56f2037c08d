// A lamp that shines and can't be hit: only sampling its points finds its light, and all methods find the same.
#include "methods/method.h"
#include "support/same_light.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

TEST(InvisibleLamp_Light, IsTheSameByEveryMethod) {
    Settings s;
    s.max_depth = 8;
    s.spp = 2;
    s.brightness_samples = 10'000;
    s.importons = 15'000;
    s.mutations = 30'000;
    s.light_paths = 30'000;
    s.photons = 15'000;
    s.chains = 50;
    Settings path = s;
    path.method = &methods::path;
    path.spp = 16;
    const auto others = test::by_methods(s, {"bdpt", "mlt", "pssmlt", "mmlt", "rjmlt", "pm", "ipm", "mps"});
    test::expect_same_light(*test::invisible_lamp_box(), path, others, 8);
}

} // namespace
} // namespace keyhole
