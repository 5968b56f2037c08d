// A plan says what the render does: both find out the same before they choose.
#include "methods/choice/expected_cost.h"
#include "methods/choice/render_in_time.h"
#include "methods/method.h"
#include "support/sanitizers.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace keyhole {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A lamp in the room that is seen, and many in closed rooms of their own.
std::unique_ptr<Scene> lamps_next_door() {
    test::SceneMaker m;
    const auto wall = make_diffuse(Rgb(0.5));
    for (int i = 0; i < 30; ++i) {
        const auto x = static_cast<float>(4 * i);
        m.room({x - 1, -1, -2}, {x + 1, 1, 2}, wall);
        m.rectangle({x - 0.2f, 0.99f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, make_black(), Rgb(5));
    }
    return m.camera({0, 0, 1.9f}, {0, -0.5f, 0}, 60).window(48, 36).build();
}

TEST(ExpectedCost, ChoosesWithTheSameTrialsAsARender) {
    const auto scene = lamps_next_door();
    const Settings s = test::settings_from("light_paths=20k importons=20k");
    set_window_margin(*scene, s);
    const ExpectedCost plan = expect_cost(*scene, s, {}, {});
    const RenderStats stats = render(*scene, s, {}).stats;
    EXPECT_EQ(plan.method, stats.method);
    ASSERT_THAT(stats.remarks, Contains(HasSubstr("chosen by trial")));
    ASSERT_THAT(stats.remarks, Contains(HasSubstr("direct light: learned")));
    for (const std::string& remark : stats.remarks) {
        const auto says = [&](const char* text) { return remark.find(text) != std::string::npos; };
        if (says("chosen by trial") || says("learned")) {
            EXPECT_THAT(plan.remarks, Contains(remark));
        }
    }
}

TEST(ExpectedCost, LearnsOfDirectLightWithinATimeAsARenderDoes) {
    const auto scene = lamps_next_door();
    const double seconds = test::kSlowdown;
    StopToken stop;
    stop.set_cpu_limit(cpu_seconds() + seconds);
    RunContext context;
    context.stop = &stop;
    const RenderStats stats = render_in_time(*scene, {}, {}, context).stats;
    const ExpectedCost plan = expect_cost(*scene, {}, {}, {}, seconds);
    const char* learning = "direct light, learned";
    EXPECT_TRUE(
        std::ranges::any_of(stats.stages, [&](const auto& x) { return x.stage->name == std::string(learning); }));
    EXPECT_THAT(plan.stages, Contains(testing::Key(learning)));
    EXPECT_THAT(plan.stages, Contains(testing::Key(stages::trials.name)));
    EXPECT_EQ(scene->direct_light(), nullptr);
}

} // namespace
} // namespace keyhole
