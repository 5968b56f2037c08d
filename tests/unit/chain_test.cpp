// The kernel on the real line, where every answer is known.
#include "core/statistics.h"
#include "sampling/markov/chain.h"
#include "support/chance.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace keyhole {
namespace {

/// A point of [0, 1] with the target 1 + x there.
struct Point {
    double x = 0, target = 0;
    explicit Point(double at) : x(at), target(at >= 0 && at <= 1 ? 1 + at : 0) {}
};

/// Moves by a uniform step of at most `reach`; fails near the upper end with probability 1/2, and then deposits nothing
/// of its own.
class Step final : public Proposal<Point> {
  public:
    explicit Step(double coverage, bool fails = false) : coverage_(coverage), fails_(fails) {}
    std::string_view name() const override { return "step"; }
    double suitability(const Point& p) const override { return fails_ ? 1 + p.x : 1; }
    std::optional<Point> propose(const Point& p, Rng& rng, Failure& why) const override {
        const double y = p.x + coverage_ * (2 * rng.next() - 1);
        if (fails_ && y > 0.7 && rng.next() < 0.5) return why = Failure::blocked, std::nullopt;
        return Point(y);
    }
    double transition_density(const Point& a, const Point& b) const override {
        const double thinned = fails_ && b.x > 0.7 ? 0.5 : 1.0;
        return std::abs(a.x - b.x) <= coverage_ ? thinned / (2 * coverage_) : 0.0;
    }

  private:
    double coverage_;
    bool fails_;
};

TEST(Chain, DepositsInProportionToItsTarget) {
    Mixture<Point> mixture;
    mixture.add(std::make_unique<Step>(0.3), 1);
    mixture.add(std::make_unique<Step>(0.8, true), 2); // its suitability depends on the state
    std::array<RunningStats, 10> share;
    for (std::uint64_t c = 0; c < 200; ++c) {
        Chain<Point> chain(Point(0.5), mixture, Rng(1, StreamPurpose::test, c));
        std::array<double, 10> bins{};
        constexpr int steps = 4000;
        double total = 0;
        for (int i = 0; i < steps; ++i) {
            chain.step([&](const Point& p, double w) {
                bins[std::min<std::size_t>(9, static_cast<std::size_t>(10 * p.x))] += w;
                total += w;
            });
        }
        EXPECT_NEAR(total, steps, 1e-6 * steps);
        for (std::size_t b = 0; b < 10; ++b) share[b].add(bins[b] / steps);
        std::uint64_t counted = 0;
        for (const LedgerEntry& e : chain.ledger()) {
            counted += e.zero + e.nan + e.rejected + e.accepted;
            for (const std::uint64_t f : e.failed) counted += f;
        }
        EXPECT_EQ(counted, static_cast<std::uint64_t>(steps));
    }
    for (std::size_t b = 0; b < 10; ++b) {
        const double expected = (0.1 + 0.01 * (static_cast<double>(b) + 0.5)) / 1.5;
        EXPECT_TRUE(test::has_mean(share[b], expected, 10, 1e-3 * expected)) << "bin " << b;
    }
}

TEST(Chain, CountsAcceptancesThatAreNotNumbersAndRejectsThem) {
    class Broken final : public Proposal<Point> {
      public:
        std::string_view name() const override { return "broken"; }
        double suitability(const Point&) const override { return 1; }
        std::optional<Point> propose(const Point&, Rng&, Failure&) const override { return Point(0.25); }
        double transition_density(const Point& x, const Point&) const override { return x.x == 0.5 ? forward_ : 1; }
        explicit Broken(double forward) : forward_(forward) {}

      private:
        double forward_;
    };
    // With a density of nothing for the move that it made, a proposal belies itself.
    for (const double forward : {std::nan(""), 0.0}) {
        Mixture<Point> mixture;
        mixture.add(std::make_unique<Broken>(forward), 1);
        Chain<Point> chain(Point(0.5), mixture, Rng(1, StreamPurpose::test, 0));
        double stayed = 0;
        for (int i = 0; i < 10; ++i)
            EXPECT_FALSE(chain.step([&](const Point& p, double w) { stayed += p.x == 0.5 ? w : 0; }));
        EXPECT_EQ(stayed, 10);
        EXPECT_EQ(chain.ledger()[0].nan, 10u);
        EXPECT_EQ(chain.longest_rejection_run(), 10u);
    }
}

} // namespace
} // namespace keyhole
