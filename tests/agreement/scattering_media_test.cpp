// Rooms full of fog and clouds: every method that shows them makes the same picture, and the others say that they
// don't.
#include "core/error.h"
#include "methods/choice/expected_cost.h"
#include "methods/method.h"
#include "methods/photons/plan.h"
#include "support/agreement.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

using testing::HasSubstr;

std::unique_ptr<Scene> small_foggy_box() {
    auto scene = test::foggy_box();
    scene->set_window({32, 32, 0});
    return scene;
}

Settings settings(const std::string& method) {
    Settings s = test::settings_from("max_depth=8 chains=100 brightness_samples=20k");
    s.method = &method_named(method);
    s.spp = method == "path" ? 64 : 24;
    s.mutations = method == "mmlt" ? 100'000 : 40'000;
    return s;
}

void expect_agreement(Scene& scene) {
    const test::Blocks bdpt = test::render_blocks(scene, settings("bdpt"), 8);
    for (const char* method : {"path", "pssmlt", "mmlt"}) {
        const test::Blocks other = test::render_blocks(scene, settings(method), 8);
        const test::Disagreement d = test::compare(other, bdpt, 0.01);
        fmt::print("{}: ratio {:.4f} +- {:.4f}, largest error of a block {:.3f}\n", method, d.ratio, d.ratio_error,
                   d.largest_error);
        EXPECT_EQ(d.rejected, 0) << method << "\n" << d.report;
        EXPECT_NEAR(d.ratio, 1, 4 * d.ratio_error + 0.005) << method;
        EXPECT_LT(d.largest_error, 0.08) << method << " is too noisy to tell";
    }
}

TEST(ScatteringMedia_Methods, Agree) { expect_agreement(*small_foggy_box()); }

/// Beams of light are as wide as the cloud.
TEST(ScatteringMedia_Methods, AgreeOnACloudInTheSky) { expect_agreement(*test::cloud_in_the_sky()); }

TEST(ScatteringMedia_Methods, AutoTakesOneThatShowsThem) {
    const auto scene = small_foggy_box();
    Settings s = settings("auto");
    s.spp = 2;
    const RenderResult result = render(*scene, s, {}, {});
    EXPECT_TRUE(method_named(result.stats.method).scatters_in_media) << result.stats.method;
}

TEST(ScatteringMedia_Methods, ThePlanHasNoPhotons) {
    const auto scene = small_foggy_box();
    Findings findings;
    plan_photons(*scene, settings("auto"), {}, {}, findings);
    EXPECT_FALSE(findings.plan->photons);
    EXPECT_TRUE(method_named(expect_cost(*scene, settings("auto"), {}, findings).method).scatters_in_media);
}

TEST(ScatteringMedia_Methods, PhotonsThatAreAskedForAreMissed) {
    const auto scene = small_foggy_box();
    Settings s = settings("auto");
    s.equalise = true;
    EXPECT_THROW(render(*scene, s, {}, {}), InputError);
}

TEST(ScatteringMedia_Methods, OthersSayThatTheyDont) {
    const auto scene = small_foggy_box();
    for (const Method* method : all_methods()) {
        if (method->scatters_in_media || method == &methods::automatic) continue;
        try {
            render(*scene, settings(std::string(method->name)), {}, {});
            ADD_FAILURE() << method->name;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), HasSubstr("expected one of path, bdpt")) << method->name;
        }
    }
}

} // namespace
} // namespace keyhole
