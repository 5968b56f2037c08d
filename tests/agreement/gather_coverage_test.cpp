// Light that gather rays hardly find, stored where it is seen: the picture is that of bidirectional path tracing.
#include "core/statistics.h"
#include "methods/method.h"
#include "methods/render.h"
#include "support/agreement.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace keyhole {
namespace {

constexpr int kRuns = 6;

TEST(Reach_AgreesWithBidirectionalTracing, BlockByBlock) {
    const auto scene = test::two_rooms(0.3f);
    Settings paths = test::settings_from("method=bdpt spp=20 seed=1k");
    const test::Blocks reference = test::render_blocks(*scene, paths, kRuns);
    Settings photons =
        test::settings_from("spp=2 cache_rays=200 brightness_samples=40k mutations=100k light_paths=50k photons=80k");
    photons.plan = Plan::all;    // whether light outside gather coverage is worth it or not
    photons.importons = 240'000; // what power by importance is wrong by falls with their number
    for (const char* method : {"mps", "ipm"}) {
        photons.method = &method_named(method);
        const test::Disagreement d = test::compare(test::render_blocks(*scene, photons, kRuns), reference, 0.03);
        std::cout << method << ": ratio " << d.ratio << ", errors up to " << d.largest_error << "\n";
        EXPECT_EQ(d.rejected, 0) << d.report << "mean brightness ratio " << d.ratio;
        EXPECT_NEAR(d.ratio, 1, 0.08) << method;
    }
}

/// What is seen through a slit is a strip, narrower than the importons around a place lie apart. Whether there is a
/// mirror somewhere, so that the eye may have other ways there, must not matter.
TEST(LightSeenThroughASlit_Brightness, IsTheSameWithAMirrorThatNobodySees) {
    Settings s = test::settings_from(
        "plan=all spp=4 brightness_samples=30k brightness_error=0 importons=5k mutations=30k photons=20k");
    s.method = &method_named("mps");
    s.cache_rays = 4; // the other layers don't count
    RunningStats without, with;
    for (const bool mirror : {false, true}) {
        const auto scene = test::two_rooms(0.03f, false, mirror);
        for (s.seed = 1; s.seed <= 3; ++s.seed) {
            const Image picture = render(*scene, s, {}).picture.layers.at("caustic");
            double sum = 0;
            for (int y = 0; y < picture.height; ++y)
                for (int x = 0; x < picture.width; ++x) sum += picture.at(x, y)[1];
            (mirror ? with : without).add(sum);
        }
    }
    const double ratio = with.mean() / without.mean();
    const double error = std::hypot(with.standard_error() / with.mean(), without.standard_error() / without.mean());
    std::cout << "with a mirror " << ratio << " +- " << error << "\n";
    EXPECT_NEAR(ratio, 1, 0.03 + 3 * error);
    EXPECT_LT(error, 0.2) << "too noisy to mean anything";
}

} // namespace
} // namespace keyhole
