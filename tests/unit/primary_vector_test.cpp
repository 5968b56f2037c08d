// The coordinates of primary sample space: their steps, and that being lazy changes nothing.
#include "core/statistics.h"
#include "sampling/primary/primary_kernel.h"
#include "support/chance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace keyhole {
namespace {

double torus_distance(double a, double b) {
    const double d = std::abs(a - b);
    return std::min(d, 1 - d);
}

TEST(SmallStep, HasTheLengthsOfKelemen) {
    Rng rng(1, StreamPurpose::test, 0);
    int forward = 0, short_half = 0;
    constexpr int n = 20'000;
    for (int i = 0; i < n; ++i) {
        const double d = SmallStep(rng.next()).distance();
        EXPECT_GE(std::abs(d), 1.0 / 1024);
        EXPECT_LE(std::abs(d), 1.0 / 64);
        forward += d > 0 ? 1 : 0;
        short_half += std::abs(d) < 1.0 / 256 ? 1 : 0; // the middle on a logarithmic scale
    }
    EXPECT_NEAR(forward, n / 2, test::most_errors(2) * std::sqrt(n / 4.0));
    EXPECT_NEAR(short_half, n / 2, test::most_errors(2) * std::sqrt(n / 4.0));
}

TEST(SmallStep, HasALogarithmThatIsUniform) {
    for (int i = 0; i < 1000; ++i) {
        const double exponent = i / 1000.0, expected = SmallStep::kLongest * std::exp2(-SmallStep::kOctaves * exponent);
        EXPECT_NEAR(SmallStep(exponent / 2).distance(), expected, 1e-8 * expected);
        EXPECT_NEAR(SmallStep(0.5 + exponent / 2).distance(), -expected, 1e-8 * expected);
    }
}

TEST(SmallStep, ShiftIsUndoneByItsNegative) {
    for (const double u : {0.01, 0.24, 0.49, 0.51, 0.76, 0.99})
        for (const double shift : {-0.25, -0.1, 0.1, 0.25})
            EXPECT_NEAR(SmallStep(u).shifted(shift).shifted(-shift).distance(), SmallStep(u).distance(), 1e-12);
}

/// A state of up to four coordinates whose number depends on the first. The target is a product of tents over the
/// coordinates in use, with a hole where proposals fail.
class Tents {
  public:
    explicit Tents(Rng& rng) : stream_(clock_, rng) {
        clock_.step = Step::large;
        while (!(propose(Step::large) > 0)) {
        }
        accept();
    }

    double propose(Step step) {
        clock_.after_large = step == Step::delayed && clock_.step == Step::large;
        clock_.attempt += step == Step::delayed ? 0 : 1;
        clock_.step = step;
        stream_.rewind();
        candidate_.fill(-1);
        candidate_[0] = stream_.next();
        const int more = candidate_[0] < 0.5 ? 1 : 3;
        double target = tent(candidate_[0]);
        for (int i = 1; i <= more; ++i) target *= 2 * tent(candidate_[static_cast<std::size_t>(i)] = stream_.next());
        if (candidate_[1] > 0.4 && candidate_[1] < 0.41) target = 0;
        return y_ = target;
    }
    void accept() {
        stream_.accept();
        ++clock_.now;
        if (clock_.step == Step::large) clock_.last_large = clock_.now;
        state_ = candidate_;
        x_ = y_;
    }
    double target() const { return x_; }
    const std::array<double, 4>& state() const { return state_; }
    const std::array<double, 4>& candidate() const { return candidate_; }

  private:
    static double tent(double x) { return 1 - std::abs(2 * x - 1); }

    PrimaryClock clock_;
    PrimaryStream stream_;
    std::array<double, 4> state_{}, candidate_{};
    double x_ = 0, y_ = 0;
};

/// Moments of the target, by integration.
struct Moments {
    double first = 0, second = 0, many = 0;
};

Moments exact() {
    Moments m;
    double total = 0;
    constexpr int n = 4000;
    double hole = 0, mean1 = 0, norm1 = 0; // of coordinate 1, whose tents integrate to 1 without the hole
    for (int j = 0; j < n; ++j) {
        const double v = (j + 0.5) / n, w = v > 0.4 && v < 0.41 ? 0 : 2 * (1 - std::abs(2 * v - 1)) / n;
        norm1 += w;
        mean1 += v * w;
        hole += w;
    }
    for (int i = 0; i < n; ++i) {
        const double u = (i + 0.5) / n, w = (1 - std::abs(2 * u - 1)) / n * norm1;
        total += w;
        m.first += u * w;
        m.many += u < 0.5 ? 0 : w;
    }
    m.first /= total;
    m.many /= total;
    m.second = mean1 / norm1;
    return m;
}

TEST(PrimaryStream, SamplesTheTargetLazily) {
    const Moments expected = exact();
    for (const Failures failures : {Failures::reject, Failures::exclude_large, Failures::delay})
        for (const double p_large : {0.02, 0.5}) {
            const PrimaryKernel kernel{failures, p_large};
            RunningStats first, second, many;
            for (std::uint64_t c = 0; c < 200; ++c) {
                Rng rng(1, StreamPurpose::test, c);
                Tents tents(rng);
                PrimaryCounts counts;
                double total = 0, sum_first = 0, sum_second = 0, sum_many = 0;
                for (int i = 0; i < 12'000; ++i)
                    kernel.step(tents, rng, counts, [&](bool candidate, double weight, bool) {
                        const auto& x = candidate ? tents.candidate() : tents.state();
                        total += weight;
                        sum_first += weight * x[0];
                        sum_second += weight * x[1];
                        sum_many += weight * (x[3] >= 0 ? 1 : 0);
                    });
                first.add(sum_first / total);
                second.add(sum_second / total);
                many.add(sum_many / total);
            }
            EXPECT_TRUE(test::has_mean(first, expected.first, 3));
            EXPECT_TRUE(test::has_mean(second, expected.second, 3));
            EXPECT_TRUE(test::has_mean(many, expected.many, 3));
            EXPECT_LT(many.standard_error(), 0.02);
        }
}

TEST(PrimaryStream, GivesSeveralNumbersAsOneByOne) {
    Rng rngs[] = {Rng(1, StreamPurpose::test, 0), Rng(1, StreamPurpose::test, 0)};
    PrimaryClock clock;
    PrimaryStream together(clock, rngs[0]), apart(clock, rngs[1]);
    for (const Step step : {Step::large, Step::small, Step::delayed, Step::stay}) {
        clock.step = step;
        clock.attempt += step == Step::delayed ? 0 : 1;
        together.rewind();
        apart.rewind();
        const auto numbers = together.take<5>();
        for (const double u : numbers) EXPECT_EQ(u, apart.next());
        EXPECT_EQ(together.used(), 5U);
        if (step != Step::large) continue;
        together.accept();
        apart.accept();
        clock.last_large = ++clock.now;
    }
}

TEST(PrimaryStream, LargeStepsRenewCoordinatesThatTheyDidNotAskFor) {
    Rng rng(1, StreamPurpose::test, 0);
    PrimaryClock clock;
    PrimaryStream stream(clock, rng);
    stream.push(0.25);
    stream.push(0.5);
    clock.step = Step::large;
    ++clock.attempt;
    stream.rewind();
    const double first = stream.next();
    stream.accept();
    clock.last_large = ++clock.now;
    clock.step = Step::small;
    ++clock.attempt;
    stream.rewind();
    EXPECT_LE(torus_distance(stream.next(), first), SmallStep::kLongest);
    EXPECT_GT(torus_distance(stream.next(), 0.5),
              2 * SmallStep::kLongest); // drawn anew; chance of failure 6 %, fixed seed
}

} // namespace
} // namespace keyhole
