// Stage one takes as many samples as B needs, and their number doesn't pull B.
#include "sampling/brightness.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

double relative_error(const StageOne& one) { return one.brightness.standard_error() / one.brightness.mean(); }

TEST(StageOneError, IsReachedWithMoreSamplesAndNoMoreThanNeeded) {
    const auto scene = test::two_rooms(0.3f);
    StageOneSettings settings{.samples = 20'000};
    const StageOne few = run_stage_one(*scene, settings, {});
    EXPECT_EQ(few.samples, 20'000);
    settings.error = relative_error(few) / 2;
    const StageOne enough = run_stage_one(*scene, settings, {});
    EXPECT_TRUE(enough.is_whole());
    EXPECT_NEAR(relative_error(enough), settings.error, 0.3 * settings.error);
    settings.error = 1e-6;
    EXPECT_EQ(run_stage_one(*scene, settings, {}).samples, 20'000 * StageOne::kMostTimes);
    settings.error = 1;
    EXPECT_EQ(run_stage_one(*scene, settings, {}).samples, 20'000);
}

/// Did the samples of B choose their own number, those that miss the few bright paths would be the ones that stop.
TEST(StageOneError, DoesNotPullTheMean) {
    const auto scene = test::two_rooms(0.1f);
    const StageOne truth = run_stage_one(*scene, {.samples = 400'000, .seed = 99}, {});
    RunningStats means;
    for (std::uint64_t seed = 1; seed <= 100; ++seed)
        means.add(run_stage_one(*scene, {.samples = 1'000, .error = 0.1, .seed = seed}, {}).brightness.mean());
    EXPECT_TRUE(test::same_mean(means, truth.brightness));
}

} // namespace
} // namespace keyhole
