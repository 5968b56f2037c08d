// Failed proposals on the real line, where every stationary density is known.
#include "core/statistics.h"
#include "sampling/primary/primary_kernel.h"
#include "support/chance.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

namespace keyhole {
namespace {

/// Target 1 on [0, 1], 0 elsewhere. Small steps are normal; large ones uniform on [-0.5, 1.5], so that half of them
/// fail.
class Line {
  public:
    Line(Rng& rng, double x) : rng_(&rng), x_(x) {}

    double propose(Step step) {
        if (step == Step::large) y_ = 2 * rng_->next() - 0.5;
        // After a failed small step from here, another one from there: both tries are then as likely seen from the
        // result.
        if (step == Step::small || (step == Step::delayed && after_large_)) y_ = x_ + normal();
        if (step == Step::delayed && !after_large_) y_ += normal();
        after_large_ = step == Step::large;
        return target_of(y_);
    }
    double target() const { return target_of(x_); }
    void accept() { x_ = y_; }
    double x() const { return x_; }
    double y() const { return y_; }

  private:
    static double target_of(double x) { return x >= 0 && x < 1 ? 1 : 0; }
    double normal() {
        const double r = std::sqrt(-2 * std::log(1 - rng_->next()));
        return 0.3 * r * std::cos(2 * std::numbers::pi * rng_->next());
    }

    Rng* rng_;
    double x_, y_ = 0;
    bool after_large_ = false;
};

/// Share of the outer tenths, each, in the chain's own deposits.
RunningStats outer_tenths(Failures failures, double p_large) {
    const PrimaryKernel kernel{failures, p_large};
    RunningStats share;
    for (std::uint64_t c = 0; c < 100; ++c) {
        Rng rng(1, StreamPurpose::test, c);
        Line line(rng, rng.next());
        PrimaryCounts counts;
        double total = 0, outer = 0;
        for (int i = 0; i < 20'000; ++i) {
            kernel.step(line, rng, counts, [&](bool candidate, double weight, bool) {
                const double x = candidate ? line.y() : line.x();
                total += weight;
                outer += x < 0.1 || x >= 0.9 ? weight : 0;
            });
        }
        EXPECT_NEAR(total, static_cast<double>(counts.steps()), 1e-6 * total);
        share.add(outer / total / 2);
    }
    return share;
}

void expect_share(const RunningStats& share, double expected) {
    EXPECT_LT(share.standard_error(), 0.0005);
    EXPECT_TRUE(test::has_mean(share, expected));
}

TEST(Failures, ThatStayRejectedLeaveTheTarget) { expect_share(outer_tenths(Failures::reject, 0), 0.1); }

TEST(Failures, LeftOutBiasTheChainByTheirProbability) {
    // Density f(x) s(x), s(x) the probability that x + 0.3 normal stays in [0, 1].
    double outer = 0, all = 0;
    constexpr int n = 10'000;
    for (int i = 0; i < n; ++i) {
        const double x = (i + 0.5) / n, scale = 0.3 * std::numbers::sqrt2;
        const double s = (std::erf((1 - x) / scale) + std::erf(x / scale)) / 2;
        all += s;
        outer += x < 0.1 || x >= 0.9 ? s / 2 : 0;
    }
    EXPECT_NEAR(outer / all, 0.075, 0.001); // and not 0.1
    expect_share(outer_tenths(Failures::exclude, 0), outer / all);
}

TEST(Failures, LeftOutWhenLargeLeaveTheTarget) { expect_share(outer_tenths(Failures::exclude_large, 0.4), 0.1); }

TEST(Failures, TriedAgainLeaveTheTarget) {
    expect_share(outer_tenths(Failures::delay, 0), 0.1);
    expect_share(outer_tenths(Failures::delay, 0.4), 0.1);
}

TEST(Failures, AreCounted) {
    for (const Failures failures : {Failures::exclude, Failures::reject, Failures::exclude_large, Failures::delay}) {
        const PrimaryKernel kernel{failures, 0.25};
        Rng rng(1, StreamPurpose::test, 0);
        Line line(rng, 0.5);
        PrimaryCounts c;
        for (int i = 0; i < 10'000; ++i) kernel.step(line, rng, c, [](bool, double, bool) {});
        EXPECT_EQ(c.proposals(), 10'000u);
        EXPECT_NEAR(c.large.failure_rate(), 0.5, 0.04);
        const std::uint64_t failed = c.small.failed + c.large.failed;
        EXPECT_EQ(c.delayed.proposed, failures == Failures::delay ? failed : 0);
        const std::uint64_t left_out[] = {failed, 0, c.large.failed, 0};
        EXPECT_EQ(c.left_out, left_out[static_cast<int>(failures)]);
        EXPECT_EQ(c.remedied() > 0, failures == Failures::delay);
    }
}

} // namespace
} // namespace keyhole
