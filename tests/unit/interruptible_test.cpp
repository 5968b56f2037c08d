// Stages that end when it is time, and renders that are stopped before they have a picture.
#include "core/shared_work.h"
#include "methods/choice/first_look.h"
#include "methods/method.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace keyhole {
namespace {

TEST(Interruptible, LoopsEndWhereTheyAreTold) {
    StopToken stop;
    RunContext context;
    context.stop = &stop;
    std::atomic<int> done = 0;
    EXPECT_THROW(with_threads(1,
                              [&] {
                                  parallel_blocks(1000, 10, context, [&](std::int64_t i) {
                                      ++done;
                                      if (i == 99) stop.request();
                                  });
                              }),
                 Interrupted);
    EXPECT_EQ(done, 100);
    done = 0;
    parallel_for(7, RunContext(), [&](std::int64_t) { ++done; });
    EXPECT_EQ(done, 7);
}

class ToldStages final : public Progress {
  public:
    void begin(std::string_view /*stage*/, std::uint64_t /*total*/, std::string_view /*unit*/) override { ++open; }
    void advance(std::uint64_t /*units*/) override {}
    void end() override { --open; }

    int open = 0;
};

TEST(Interruptible, StagesEndWhereverTheyAreLeft) {
    ToldStages told;
    RunContext context;
    context.progress = &told;
    const auto leave = [&] {
        const ProgressStage stage(context, "stage", 1, "units");
        EXPECT_EQ(told.open, 1);
        throw Interrupted();
    };
    EXPECT_THROW(leave(), Interrupted);
    EXPECT_EQ(told.open, 0);
}

class StoppedAtOnce : public testing::TestWithParam<const char*> {};

TEST_P(StoppedAtOnce, RendersLeaveALook) {
    const auto scene = test::mirror_glass_box();
    Settings s;
    s.method = &method_named(GetParam());
    StopToken stop;
    stop.request();
    RunContext context;
    context.stop = &stop;
    const RenderResult result = render(*scene, s, context);
    EXPECT_TRUE(has_picture(result));
    EXPECT_FALSE(result.stats.complete);
    const Image& beauty = result.picture.layers.at("beauty");
    for (const float v : beauty.data) ASSERT_TRUE(std::isfinite(v));
    EXPECT_GT(*std::ranges::max_element(beauty.data), 0);
}

INSTANTIATE_TEST_SUITE_P(Methods, StoppedAtOnce,
                         testing::Values("auto", "path", "bdpt", "mlt", "pssmlt", "mmlt", "rjmlt", "pm", "ipm", "mps"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
