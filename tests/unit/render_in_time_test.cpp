// Renders that fill a time: what they predict, and what they make of several pictures.
#include "core/error.h"
#include "core/statistics.h"
#include "film/join.h"
#include "methods/choice/differences.h"
#include "methods/choice/experience.h"
#include "methods/choice/render_in_time.h"
#include "methods/method.h"
#include "scene/emitters/emitters.h"
#include "support/sanitizers.h"
#include "support/scratch_directory.h"
#include "support/test_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace keyhole {
namespace {

double mean_luminance(const Picture& picture) {
    const Image& beauty = picture.layers.at("beauty");
    RunningStats s;
    for (std::size_t i = 0; i < beauty.data.size(); i += 3)
        s.add(luminance({beauty.data[i], beauty.data[i + 1], beauty.data[i + 2]}));
    return s.mean();
}

TEST(StageWork, IsInProportionToWhatAStageDoes) {
    Settings one, other;
    other.spp = 3 * one.spp;
    other.mutations = 5 * one.mutations;
    other.light_paths = 7 * one.light_paths;
    const auto ratio = [&](const Stage& stage) { return stage_work(stage, other, 100) / stage_work(stage, one, 100); };
    EXPECT_DOUBLE_EQ(ratio(stages::gather), 3);
    EXPECT_DOUBLE_EQ(ratio(stages::photons_of_chains), 5);
    EXPECT_DOUBLE_EQ(ratio(stages::seeds), 1);
    EXPECT_DOUBLE_EQ(stage_work(stages::gather, one, 200) / stage_work(stages::gather, one, 100), 2);
    EXPECT_DOUBLE_EQ(stage_work(stages::chains, one, 200) / stage_work(stages::chains, one, 100), 1);
    EXPECT_DOUBLE_EQ(ratio(stages::photons_of_light_paths), 7);
    other.passes = 2 * one.passes;
    EXPECT_DOUBLE_EQ(ratio(stages::photons_of_light_paths), 14);
}

TEST(StageWork, OfWhatIsDoneOnceAndWithinBoundsIsNoMore) {
    const Stage bounded{.name = "", .setting = &Settings::light_paths, .least = 100, .most = 1000, .once = true};
    Settings few, more, many;
    few.light_paths = 10;
    more.light_paths = 300;
    many.light_paths = 5000;
    many.passes = 4;
    EXPECT_DOUBLE_EQ(stage_work(bounded, more, 1) / stage_work(bounded, few, 1), 3);
    EXPECT_DOUBLE_EQ(stage_work(bounded, many, 1) / stage_work(bounded, few, 1), 10);
}

TEST(Blend, IsTheWeightedMeanOfEveryLayer) {
    Picture a{2, 1, {{"x", Image(2, 1, 1)}, {"y", Image(2, 1, 3)}}, {}, {}}, b = a;
    a.layers["x"].data = {1, 2};
    b.layers["x"].data = {5, 2};
    b.layers["y"].data[4] = 8;
    blend(a, b, 0.25);
    EXPECT_EQ(a.layers["x"].data, (std::vector<float>{2, 2}));
    EXPECT_EQ(a.layers["y"].data, (std::vector<float>{0, 0, 0, 0, 2, 0}));
    b.layers.erase("y");
    EXPECT_THROW(blend(a, b, 0.5), InputError);
}

class RenderInTime : public testing::TestWithParam<const char*> {};

/// Means of renders are as bright as each, whatever their weights; and the small trial leaves no trace in the scene.
TEST_P(RenderInTime, IsAsBrightAsTheScene) {
    const auto scene = test::diffuse_box();
    const ImageWindow window = scene->camera().window();
    Settings s;
    s.spp = 128;
    s.method = &methods::path;
    const double expected = mean_luminance(render(*scene, s, {}).picture);
    s = {};
    s.method = &method_named(GetParam());
    StopToken stop;
    stop.set_cpu_limit(cpu_seconds() + test::kSlowdown);
    RunContext context;
    context.stop = &stop;
    const RenderResult result = render_in_time(*scene, s, {}, context);
    EXPECT_NEAR(mean_luminance(result.picture) / expected, 1, 0.08);
    EXPECT_EQ(result.picture.width, window.width);
    EXPECT_EQ(result.picture.height, window.height);
    EXPECT_EQ(scene->camera().window().width, window.width);
    EXPECT_EQ(result.settings.seed, s.seed);
    EXPECT_TRUE(std::ranges::any_of(result.stats.stages, [](const auto& s) { return s.stage == &stages::trials; }));
}

/// A ball under an even sky: photons are no match for paths.
std::unique_ptr<Scene> ball_outdoors() {
    test::SceneMaker m;
    return m.rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, make_diffuse(Rgb(0.3)))
        .sphere({0, 0.5f, 0}, 0.5f, make_diffuse(Rgb(0.5)))
        .emitter(make_constant_environment(Rgb(1.0)))
        .camera({0, 1, 3}, {0, 0.5f, 0}, 45)
        .window(32, 24)
        .build();
}

RenderResult render_by_auto(Scene& scene, const Settings& s, double seconds) {
    StopToken stop;
    stop.set_cpu_limit(cpu_seconds() + seconds);
    RunContext context;
    context.stop = &stop;
    return render_in_time(scene, s, {}, context);
}

TEST(AutoInTime, ChoosesAMethodThatKeepsPhotonsWhereTheyAreToBeSaved) {
    const auto scene = ball_outdoors();
    EXPECT_FALSE(method_named(render_by_auto(*scene, {}, test::kSlowdown).stats.method).keeps_photons);
    const ScratchDirectory directory;
    Settings s;
    s.save_map = directory.path("map.photons");
    const RenderResult result = render_by_auto(*scene, s, 2 * test::kSlowdown);
    EXPECT_TRUE(method_named(result.stats.method).keeps_photons) << result.stats.method;
    EXPECT_TRUE(std::filesystem::exists(s.save_map));
}

// A method that isn't named is taken for one that has lost.
// Renders that fill a time have seeds of their own; that is nobody's choice.
TEST(DifferencesOfSettings, AreThoseThatSomebodyOrTheTimeHasSet) {
    Settings a, b;
    b.seed = 553'099'248'985'520;
    EXPECT_EQ(differences(a, b), "");
    b.spp = 3;
    EXPECT_EQ(differences(a, b), " spp=3");
}

TEST(AutoInTime, NamesEveryMethodThatItTriedOrHadNoTimeFor) {
    const auto scene = test::diffuse_box();
    const RenderResult result = render_by_auto(*scene, {}, 0.5 * test::kSlowdown);
    const auto choice = std::ranges::find_if(result.stats.remarks, [&](const std::string& remark) {
        return remark.find("chosen by trial") != std::string::npos;
    });
    ASSERT_NE(choice, result.stats.remarks.end());
    for (const Method* method : all_methods()) {
        if (method->trial.share > 0) {
            EXPECT_THAT(*choice, testing::ContainsRegex("[ ,]" + std::string(method->name) + "( |,|$)"));
        }
    }
}

TEST(AutoInTime, SaysWhenThereIsNoTimeForPhotonsThatWereToBeSaved) {
    const auto scene = ball_outdoors();
    const ScratchDirectory directory;
    Settings s;
    s.save_map = directory.path("map.photons");
    const RenderResult result = render_by_auto(*scene, s, 0.001);
    EXPECT_FALSE(std::filesystem::exists(s.save_map));
    EXPECT_THAT(result.stats.warnings, testing::Contains(testing::HasSubstr("no photons were saved")));
}

INSTANTIATE_TEST_SUITE_P(Methods, RenderInTime, testing::Values("auto", "mps", "mlt", "pssmlt"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
