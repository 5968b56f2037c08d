// A lamp that shines and can't be hit: only sampling its points finds its light, and all methods find the same.
#include "support/agreement.h"
#include "support/test_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr int kRuns = 4;

Settings base(const char* method) {
    Settings s;
    s.method = &method_named(method);
    s.max_depth = 8;
    s.spp = 8;
    s.brightness_samples = 30'000;
    s.importons = 30'000;
    s.mutations = 80'000;
    s.photons = 40'000;
    s.chains = 200;
    return s;
}

TEST(InvisibleLamp_Light, IsTheSameByEveryMethod) {
    const auto scene = test::invisible_lamp_box();
    scene->set_window({48, 32, 0});
    Settings path = base("path");
    path.spp = 64;
    path.seed = 1000;
    const test::Blocks reference = test::render_blocks(*scene, path, kRuns);
    for (const char* method : {"bdpt", "mlt", "pssmlt", "mmlt", "rjmlt", "pm", "ipm", "mps"}) {
        const test::Disagreement d = test::compare(test::render_blocks(*scene, base(method), kRuns), reference, 0.03);
        EXPECT_EQ(d.rejected, 0) << fmt::format("{}\n{}mean brightness ratio {}", method, d.report, d.ratio);
        EXPECT_NEAR(d.ratio, 1, 0.03) << method;
    }
}

} // namespace
} // namespace keyhole
