// Passes: their mean converges to what path tracing finds, within the memory of one.
#include "film/image_error.h"
#include "methods/method.h"
#include "support/agreement.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

class Passes : public testing::TestWithParam<const char*> {
  protected:
    static Settings settings() {
        Settings s = test::settings_from("spp=1 gather_rays=1 photon_memory=256KiB light_paths=10k mutations=20k "
                                         "brightness_samples=10k importons=20k");
        s.method = &method_named(GetParam());
        s.irradiance_cache = false;      // interpolation has an error of its own
        s.power = PowerRule::reciprocal; // of mps: passes can't average the error of an importance map away
        return s;
    }
};

TEST_P(Passes, ConvergeToPathTracing) {
    const auto scene = test::diffuse_box();
    Settings path = test::settings_from("method=path spp=16 seed=1k");
    Settings passes = settings();
    passes.passes = 3;
    // With a quarter of the photons mps is 1 % too dark: they leave the dark corners of the box to chance.
    passes.photon_memory *= 4;
    passes.light_paths *= 4;
    passes.mutations *= 4;
    const test::Disagreement d =
        test::compare(test::render_blocks(*scene, passes, 8), test::render_blocks(*scene, path, 16), 0.01);
    EXPECT_EQ(d.rejected, 0) << d.report << "mean brightness ratio " << d.ratio;
}

TEST_P(Passes, SayHowFarTheyAre) {
    const auto scene = test::diffuse_box();
    Settings s = settings();
    s.passes = 0;
    s.target_error = 0.25;
    const RenderResult result = render(*scene, s, {});
    EXPECT_GE(result.stats.passes, 4);
    EXPECT_LE(result.stats.values.at("relative error"), 0.25);
    EXPECT_GT(result.stats.values.at("relative error"), 0.15) << "passes were wasted";
    Settings path; // its error is a small part of what is to be told
    path.method = &methods::path;
    path.spp = 512;
    path.seed = 77;
    const Picture reference = render(*scene, path, {}).picture;
    const double error = image_error(result.picture.layers.at("beauty"), reference.layers.at("beauty")).relmse;
    EXPECT_NEAR(std::sqrt(error), result.stats.values.at("relative error"), 0.07);
}

INSTANTIATE_TEST_SUITE_P(Methods, Passes, testing::Values("ipm", "mps"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
