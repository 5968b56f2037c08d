// The study of Zeng and Wei 2019 on the real line, and what it does not show.
#include "sampling/primary/failure_study.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

FailureStudyResult published(double failure, Failures failures) {
    return run_failure_study({.failure = failure, .failures = failures, .repeats = 300});
}

TEST(FailureStudy, ReproducesThePublishedErrors) { // their table 2
    EXPECT_NEAR(published(0.4, Failures::reject).rmse, 0.00683, 0.05 * 0.00683);
    EXPECT_NEAR(published(0.6, Failures::reject).rmse, 0.00876, 0.05 * 0.00876);
    EXPECT_NEAR(published(0.4, Failures::exclude).rmse, 0.00637, 0.05 * 0.00637);
    EXPECT_NEAR(published(0.6, Failures::exclude).rmse, 0.00773, 0.05 * 0.00773);
}

TEST(FailureStudy, DelayedRejectionBeatsLeavingOut) {
    for (const double failure : {0.4, 0.6})
        EXPECT_LT(published(failure, Failures::delay).rmse, 0.95 * published(failure, Failures::exclude).rmse);
}

TEST(FailureStudy, LongerChainsDoNotMendTheBiasOfLeavingOut) {
    FailureStudy study{.target = FailureStudy::Target::half_normal, .p_large = 0.25, .proposals = 25'600};
    const auto bias = [&](Failures failures) {
        study.failures = failures;
        return run_failure_study(study).bias;
    };
    EXPECT_NEAR(bias(Failures::exclude), 0.0054, 0.0004);
    EXPECT_LT(bias(Failures::reject), 0.0004);
    EXPECT_LT(bias(Failures::exclude_large), 0.0004);
    EXPECT_LT(bias(Failures::delay), 0.0004);
}

} // namespace
} // namespace keyhole
