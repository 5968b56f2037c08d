// What chance may do: how many standard errors an estimate may be off before a test calls it wrong. Every change of a
// random stream draws all estimates anew, more than a thousand of them; four standard errors for each would fail too
// often.
#pragma once

#include "core/statistics.h"

#include <gtest/gtest.h>

#include <limits>

namespace keyhole::test {

/// Probability with which chance alone fails one test, over all that the test compares.
constexpr double kChance = 1e-4;

/// Two-sided p-value of a t-distributed statistic.
double student_p_value(double t, double degrees_of_freedom);

/// Level of one of `tests` tests, that all of them together reject the truth with probability `significance`
/// (Sidak 1967).
double sidak_threshold(int tests, double significance = kChance);

/// The most standard errors by which one of `comparisons` estimates may be off, that all of them keep to it but with
/// probability kChance. Student's distribution, where `samples` tells of how many values their errors were estimated.
double most_errors(int comparisons = 1, double samples = std::numeric_limits<double>::infinity());

/// Whether `found`, one of `comparisons`, has the mean `expected`, up to a systematic error of `tolerance`.
testing::AssertionResult has_mean(const RunningStats& found, double expected, int comparisons = 1,
                                  double tolerance = 0);

/// Whether both, a pair of `comparisons`, have the same mean.
testing::AssertionResult same_mean(const RunningStats& a, const RunningStats& b, int comparisons = 1);

} // namespace keyhole::test
