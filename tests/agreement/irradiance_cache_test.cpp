// Cached irradiance makes the picture that gather rays from every sample make.
#include "support/agreement.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

void expect_agreement(Scene& scene) {
    Settings settings = test::settings_from(
        "method=ipm spp=2 brightness_samples=20k importons=20k mutations=30k light_paths=30k photons=10k");
    // The method is told, as `auto` takes it here after trials that cost as much again.
    constexpr int kRuns = 4;
    const test::Blocks cached = test::render_blocks(scene, settings, kRuns, "indirect");
    settings.irradiance_cache = false;
    settings.seed = 100;
    const test::Disagreement d = test::compare(cached, test::render_blocks(scene, settings, kRuns, "indirect"), 0.02);
    EXPECT_EQ(d.rejected, 0) << d.report << "mean brightness ratio " << d.ratio;
    testing::Test::RecordProperty("largest_error", std::to_string(d.largest_error));
    EXPECT_NEAR(d.ratio, 1, 0.03);
    EXPECT_LT(d.largest_error, 0.06) << "too noisy to tell";
}

TEST(IrradianceCache, AgreesWithGatherRays) { expect_agreement(*test::diffuse_box()); }

TEST(IrradianceCache, AgreesThroughMirrorsGlassAndALens) { expect_agreement(*test::mirror_glass_box(0.05f)); }

} // namespace
} // namespace keyhole
