#include "sampling/markov/acceptance.h"
#include "sampling/markov/chain_rounds.h"
#include "sampling/primary/primary_kernel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace keyhole {
namespace {

using testing::ElementsAre;

std::vector<std::int64_t> lengths(const ChainRounds& rounds, const RunContext& context = {}) {
    std::vector<std::int64_t> all;
    std::int64_t sum = 0;
    const std::int64_t done = rounds.run(context, [&](std::int64_t n) {
        all.push_back(n);
        sum += n;
    });
    EXPECT_EQ(done, sum);
    return all;
}

TEST(ChainRounds, MakeAllStepsInRoundsOfOneLengthOrInEvenOnes) {
    EXPECT_THAT(lengths(ChainRounds::of_length(10, 4)), ElementsAre(4, 4, 2));
    EXPECT_THAT(lengths(ChainRounds::of_length(3, 4)), ElementsAre(3));
    EXPECT_THAT(lengths(ChainRounds::even(10, 4)), ElementsAre(2, 3, 2, 3));
    EXPECT_THAT(lengths(ChainRounds::even(2, 2)), ElementsAre(1, 1));
}

TEST(ChainRounds, EndAfterTheFirstWhereTheyAreStopped) {
    StopToken stop;
    stop.request();
    RunContext context;
    context.stop = &stop;
    EXPECT_THAT(lengths(ChainRounds::of_length(10, 4), context), ElementsAre(4));
    EXPECT_THAT(lengths(ChainRounds::even(10, 4), context), ElementsAre(2));
}

TEST(LearningBatch, IsTheFirst32ndPartAndLeavesOneStepAtLeast) {
    EXPECT_EQ(LearningBatch(320).steps, 10);
    EXPECT_EQ(LearningBatch(320).rest, 310);
    EXPECT_EQ(LearningBatch(1).steps, 1);
    EXPECT_EQ(LearningBatch(1).rest, 1);
}

TEST(Acceptance, IsTheRatioUpToOneAndNothingWhereThatIsNoFiniteNumber) {
    EXPECT_EQ(acceptance(0.25), 0.25);
    EXPECT_EQ(acceptance(3), 1);
    EXPECT_EQ(acceptance(0), 0);
    EXPECT_EQ(acceptance(std::numeric_limits<double>::infinity()), 0);
    EXPECT_EQ(acceptance(std::numeric_limits<double>::quiet_NaN()), 0);
}

TEST(Acceptance, DepositsBothStatesByTheirProbabilities) {
    for (const double a : {0.0, 0.3, 1.0}) {
        double state = 0, candidate = 0, accepted = 0;
        Rng rng(1, StreamPurpose::test, 0);
        constexpr int n = 10'000;
        for (int i = 0; i < n; ++i)
            accepted += deposit_and_accept(
                a, rng, [&](bool of_candidate, double w) { (of_candidate ? candidate : state) += w; });
        EXPECT_NEAR(state, (1 - a) * n, 1e-6 * n);
        EXPECT_NEAR(candidate, a * n, 1e-6 * n);
        EXPECT_NEAR(accepted, a * n, 5 * std::sqrt(a * (1 - a) * n));
    }
}

} // namespace
} // namespace keyhole
