// An eye that sees along parallels: paths from the eye, from the light and from photons show the same picture.
#include "methods/method.h"
#include "methods/render.h"
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
    s.brightness_samples = 150'000;
    s.importons = 30'000;
    s.mutations = 400'000;
    s.light_paths = 250'000;
    s.photons = 120'000;
    s.chains = 200;
    return s;
}

TEST(ParallelSight_Light, IsTheSameByEveryMethod) {
    const auto scene = test::parallel_sight_box();
    scene->set_window({48, 32, 0});
    // Both ends: what few paths from the eye alone find of caustics is noise.
    Settings paths = base("bdpt");
    paths.spp = 200;
    paths.seed = 1000;
    const test::Blocks reference = test::render_blocks(*scene, paths, kRuns);
    for (const char* method : {"path", "mlt", "mmlt", "pm", "ipm", "mps"}) {
        Settings s = base(method);
        if (s.method == &methods::path) s.spp = 400;
        const test::Disagreement d = test::compare(test::render_blocks(*scene, s, kRuns), reference, 0.03);
        EXPECT_EQ(d.rejected, 0) << fmt::format("{}\n{}mean brightness ratio {}", method, d.report, d.ratio);
        EXPECT_NEAR(d.ratio, 1, 0.03) << method;
        fmt::print("{}: ratio {:.4f}, worst {:.4f}, largest error {:.4f}\n", method, d.ratio, d.worst, d.largest_error);
    }
}

/// The room's rear wall is 3.9 m from the plane, behind what a pinhole 1800 m away measures.
TEST(ParallelSight_Depth, IsCountedFromItsPlane) {
    for (const char* method : {"path", "ipm"}) {
        const auto scene = test::parallel_sight_box();
        scene->set_window({12, 8, 0});
        Settings s = base(method);
        s.spp = 4;
        const RenderResult result = render(*scene, s, {});
        EXPECT_NEAR(result.picture.layers.at("depth").at(5, 1)[0], 3.9, 0.02) << method;
    }
}

} // namespace
} // namespace keyhole
