// "Model no more than a scene needs": what is left out is left out, by the statistics, and nothing else is.
#include "methods/choice/affordable.h"
#include "methods/choice/effort.h"
#include "methods/method.h"
#include "methods/photons/plan.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

using namespace keyhole;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

namespace {

Settings small_settings(const std::string& method) {
    Settings s = test::settings_from(
        "spp=1 gather_rays=1 brightness_samples=20k mutations=20k light_paths=20k importons=20k cache_rays=64");
    s.method = &method_named(method);
    return s;
}

RenderStats render_stats(Scene& scene, const Settings& settings) { return render(scene, settings, {}).stats; }

bool has_stage(const RenderStats& stats, const std::string& name) {
    return std::ranges::any_of(stats.stages, [&](const StageStats& s) { return s.stage->name == name; });
}

bool has_proposal(const RenderStats& stats, const std::string& part) {
    return std::ranges::any_of(stats.proposals,
                               [&](const ProposalStats& p) { return p.name.find(part) != std::string::npos; });
}

/// A lit room beside the closed one that the camera is in.
std::unique_ptr<Scene> light_next_door() {
    test::SceneMaker m;
    const auto white = make_diffuse(Rgb(0.7));
    m.room({0, 0, 0}, {1, 1, 1}, white).room({2, 0, 0}, {3, 1, 1}, white);
    m.rectangle({2.4f, 0.99f, 0.4f}, {0.2f, 0, 0}, {0, 0, 0.2f}, white, Rgb(20.0));
    return m.camera({0.5f, 0.5f, 0.9f}, {0.5f, 0.5f, 0}, 60).window(24, 16).build();
}

/// A lamp over a plane, and nothing else that could scatter light.
std::unique_ptr<Scene> lamp_over_plane() {
    test::SceneMaker m;
    m.rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, make_diffuse(Rgb(0.7)));
    m.rectangle({-0.2f, 2, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, make_black(), Rgb(20.0));
    return m.camera({0, 1, 3}, {0, 0, 0}, 40).window(24, 16).build();
}

class PlanOfPhotons : public testing::TestWithParam<const char*> {};

} // namespace

TEST_P(PlanOfPhotons, ADiffuseSceneHasNothingForCaustics) {
    const auto scene = test::diffuse_box();
    const RenderStats stats = render_stats(*scene, small_settings(GetParam()));
    EXPECT_GT(stats.photons_global, 0u);
    EXPECT_EQ(stats.photons_caustic, 0u);
    EXPECT_FALSE(has_proposal(stats, "caustic"));
    EXPECT_FALSE(has_proposal(stats, "multi_chain"));
    // One importance map, not two: each eye path leaves at most one importon there.
    EXPECT_LE(stats.importons, 20'000u);
}

TEST_P(PlanOfPhotons, ASpecularSceneHasAllOfIt) {
    const auto scene = test::mirror_glass_box();
    const RenderStats stats = render_stats(*scene, small_settings(GetParam()));
    EXPECT_GT(stats.photons_caustic, 0u);
    EXPECT_EQ(has_proposal(stats, "caustic"), std::string(GetParam()) == "mps");
}

TEST_P(PlanOfPhotons, LightThatTheEyeCannotSeeStopsEarlyAndSaysSo) {
    for (const auto& make : {light_next_door, lamp_over_plane}) {
        const auto scene = make();
        const RenderStats stats = render_stats(*scene, small_settings(GetParam()));
        EXPECT_THAT(stats.remarks, Contains(HasSubstr("no indirect light reaches the eye")));
        EXPECT_THAT(stats.warnings, Not(Contains(HasSubstr("no photon was stored")))) << "as was to be expected";
        EXPECT_EQ(stats.photons_global + stats.photons_caustic + stats.importons + stats.photon_bytes, 0u);
        for (const char* stage : {"importance", "brightness", "photons"})
            EXPECT_FALSE(has_stage(stats, stage)) << stage;
        EXPECT_TRUE(stats.complete);
    }
}

TEST_P(PlanOfPhotons, AskedForAllItLeavesOutNothing) {
    const auto scene = light_next_door();
    Settings settings = small_settings(GetParam());
    settings.plan = Plan::all;
    const RenderStats stats = render_stats(*scene, settings);
    EXPECT_TRUE(has_stage(stats, std::string(GetParam()) == "mps" ? "brightness" : "photons"));
}

INSTANTIATE_TEST_SUITE_P(Methods, PlanOfPhotons, testing::Values("mps", "ipm", "auto"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Plan, LightThroughASlitIsNotGivenUp) {
    const auto scene = test::two_rooms(0.003f);
    const Settings settings = small_settings("auto");
    const SurfacePatches patches(*scene);
    EXPECT_TRUE(plan_render({*scene, settings, patches, {}}, {}).photons);
}

TEST(Plan, SurveyKnowsWhichLightIsSeen) {
    const auto scene = lamp_over_plane();
    const SceneSurvey survey = survey_scene(*scene, 4096, 8, 1);
    EXPECT_GT(survey.of(LightClass::direct).mean(), 0);
    EXPECT_EQ(survey.stored() + survey.of(LightClass::second).mean(), 0);
    EXPECT_EQ(survey.specular, 0);
    EXPECT_NEAR(survey.diffuse + survey.nothing, 1, 1e-9);
    ASSERT_EQ(survey.by_emitter.size(), 1u);
    EXPECT_NEAR(survey.by_emitter[0], survey.total(), 1e-9 * survey.total());
}

TEST(Effort, GrowsEverythingButWhatIsGiven) {
    Settings s;
    s.method = &methods::ipm;
    s.spp = 3;
    const Settings less = with_effort(s, 1, 320 * 240, {"spp"}), more = with_effort(s, 8, 320 * 240, {"spp"});
    EXPECT_EQ(less.spp, 3);
    EXPECT_EQ(more.spp, 3);
    for (const auto member : {&Settings::light_paths, &Settings::mutations, &Settings::photons, &Settings::importons,
                              &Settings::brightness_samples, &Settings::cache_rays})
        EXPECT_GT(more.*member, less.*member);
    EXPECT_LT(more.cache_min_reach, less.cache_min_reach);
    EXPECT_EQ(with_effort(s, 8, 320 * 240, {"cache_min_reach"}).cache_min_reach, s.cache_min_reach);
    EXPECT_EQ(more.passes, 1);
}

TEST(Effort, KeepsMorePhotonsThanItNeedsWhileTheMemoryHoldsThem) {
    Settings s;
    s.method = &methods::ipm;
    const Settings little = with_effort(s, 4, 320 * 240, {});
    EXPECT_EQ(little.passes, 1);
    s.photon_memory /= 2;
    const Settings less = with_effort(s, 4, 320 * 240, {});
    EXPECT_EQ(less.passes, 1) << "what is needed is held";
    EXPECT_LT(less.photons, little.photons);
    EXPECT_LE(2 * little.photons, little.light_paths);
}

TEST(Effort, WhatIsGivenLeavesTimeForTheRest) {
    // Photons, records and samples that took 1, 3 and 4 s in a render of effort 1.
    constexpr std::int64_t kPixels = 32 * 24; // many samples of each
    constexpr double kTime = 8;               // [s]
    Settings s;
    s.method = &methods::ipm;
    RenderStats stats;
    stats.stages = {{&stages::photons_of_light_paths, 1, 1, 0}, {&stages::cache, 3, 3, 0}, {&stages::gather, 4, 4, 0}};
    const Experience cost(with_effort(s, 1, kPixels, {}), 1, kPixels, stats, kTime);
    const auto rest = [&](std::int64_t rays, const std::set<std::string>& given) {
        s.cache_rays = rays;
        const double effort = affordable_effort(cost, s, given, {}, kPixels, kTime);
        const Settings chosen = with_effort(s, effort, kPixels, given);
        return cost.predict(stages::photons_of_light_paths, 1, chosen, kPixels) +
               cost.predict(stages::gather, 4, chosen, kPixels);
    };
    const double free = rest(0, {});
    EXPECT_NEAR(free, 5, 0.1);
    EXPECT_NEAR(rest(1500, {"cache_rays"}), 5, 0.2) << "no more than would be chosen";
    EXPECT_NEAR(rest(6000, {"cache_rays"}), 0.4 * kTime, 0.1) << "records alone would take all of the time and more";
    EXPECT_NEAR(cost_of_given(cost, s, {"cache_rays"}, kPixels), 12, 0.2);
    EXPECT_EQ(cost_of_given(cost, s, {"seed"}, kPixels), 0);
}

TEST(Effort, SpreadsOverPassesWhatTheMemoryCannotHold) {
    Settings s;
    s.method = &methods::ipm;
    s.photon_memory = 1 << 20;
    const Settings one = with_effort(s, 1, 320 * 240, {}), many = with_effort(s, 64, 320 * 240, {});
    EXPECT_GT(many.passes, one.passes);
    EXPECT_LE(many.photons * 24, 1 << 20);
}
