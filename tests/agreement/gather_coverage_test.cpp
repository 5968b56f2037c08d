// Light that gather rays hardly find, stored where it is seen: the picture is that of bidirectional path tracing.
#include "methods/method.h"
#include "support/agreement.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <iostream>

namespace keyhole {
namespace {

constexpr int kRuns = 6;

TEST(Reach_AgreesWithBidirectionalTracing, BlockByBlock) {
    const auto scene = test::two_rooms(0.3f);
    Settings paths;
    paths.method = &methods::bdpt;
    paths.spp = 20;
    paths.seed = 1000;
    const test::Blocks reference = test::render_blocks(*scene, paths, kRuns);
    Settings photons;
    photons.plan = Plan::all; // whether light outside gather coverage is worth it or not
    photons.spp = 2;
    photons.cache_rays = 200;
    photons.brightness_samples = 40'000;
    photons.importons = 240'000; // what power by importance is wrong by falls with their number
    photons.mutations = 100'000;
    photons.light_paths = 50'000;
    photons.photons = 80'000;
    for (const char* method : {"mps", "ipm"}) {
        photons.method = &method_named(method);
        const test::Disagreement d = test::compare(test::render_blocks(*scene, photons, kRuns), reference, 0.03);
        std::cout << method << ": ratio " << d.ratio << ", errors up to " << d.largest_error << "\n";
        EXPECT_EQ(d.rejected, 0) << d.report << "mean brightness ratio " << d.ratio;
        EXPECT_NEAR(d.ratio, 1, 0.08) << method;
    }
}

} // namespace
} // namespace keyhole
