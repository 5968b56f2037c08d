#include "sampling/primary/primary_kernel.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

PrimaryCounts counts(double eta_s, double eta_l, double eta_0) {
    PrimaryCounts c;
    c.small = {1000, 0, 0, 1000 * eta_s};
    c.large = {1000, 1000 - static_cast<std::uint64_t>(1000 * eta_0), 0, 1000 * eta_l};
    return c;
}

TEST(LargeStepRule, FollowsTheFormulaWhereLargeStepsAreAccepted) {
    const LargeStepRule rule = large_step_rule(counts(0.9, 0.3, 0.8));
    EXPECT_TRUE(rule.by_formula);
    EXPECT_NEAR(rule.p_large, 0.9 / (2 * 0.6), 1e-12);
    EXPECT_NEAR(rule.eta_s, 0.9, 1e-12);
    EXPECT_NEAR(rule.eta_l, 0.3, 1e-12);
    EXPECT_NEAR(rule.eta_0, 0.8, 1e-12);
}

TEST(LargeStepRule, IsAQuarterWhereTheyAreNot) {
    const LargeStepRule rule = large_step_rule(counts(0.9, 0.03, 0.8));
    EXPECT_FALSE(rule.by_formula);
    EXPECT_EQ(rule.p_large, 0.25);
}

TEST(LargeStepRule, StaysBetweenZeroAndOne) {
    EXPECT_EQ(large_step_rule(counts(0.9, 0.8, 0.9)).p_large, 1.0);
    EXPECT_EQ(large_step_rule(counts(0.5, 0.5, 0.9)).p_large, 1.0); // no division by zero
    EXPECT_EQ(large_step_rule(counts(0.4, 0.6, 0.9)).p_large, 1.0); // nor a negative probability
    EXPECT_EQ(large_step_rule(counts(0.4, 0, 0)).p_large, 0.25);    // no large step found light
    EXPECT_EQ(large_step_rule({}).p_large, 0.25);
}

} // namespace
} // namespace keyhole
