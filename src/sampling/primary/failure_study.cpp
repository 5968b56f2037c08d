#include "sampling/primary/failure_study.h"

#include "sampling/primary/primary_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace keyhole {
namespace {

constexpr int kBins = 52;
constexpr double kMean = 3, kDeviation = 2, kWidth = 0.25, kLowest = kMean - kWidth * kBins / 2;

using Histogram = std::array<double, kBins>;

double normal(Rng& rng) {
    return std::sqrt(-2 * std::log(1 - rng.next())) * std::cos(2 * std::numbers::pi * rng.next());
}

/// Space of PrimaryKernel.
class Line {
  public:
    Line(const FailureStudy& study, Rng& rng) : study_(&study), rng_(&rng) {
        x_ = normal(rng);
        if (half()) x_ = std::abs(x_);
        x_ = kMean + kDeviation * x_;
    }

    double propose(Step step) {
        // A delayed step goes on from where the first one failed, unless that was a large step.
        const double from = step == Step::delayed && !large_ ? y_ : x_;
        large_ = step == Step::large;
        y_ = large_ ? kLowest + kWidth * kBins * rng_->next() : from + kDeviation * normal(*rng_);
        const bool fails = half() ? y_ < kMean : rng_->next() < study_->failure;
        return fails ? 0 : density(y_);
    }
    double target() const { return density(x_); }
    void accept() { x_ = y_; }
    double x() const { return x_; }
    double y() const { return y_; }

  private:
    bool half() const { return study_->target == FailureStudy::Target::half_normal; }
    static double density(double x) { return std::exp(-(x - kMean) * (x - kMean) / (2 * kDeviation * kDeviation)); }

    const FailureStudy* study_;
    Rng* rng_;
    double x_, y_ = 0;
    bool large_ = false;
};

Histogram exact(FailureStudy::Target target) {
    const auto below = [&](double x) {
        const double c = std::erf((x - kMean) / (kDeviation * std::numbers::sqrt2));
        return target == FailureStudy::Target::normal ? (1 + c) / 2 : std::max(0.0, c);
    };
    Histogram h;
    for (int b = 0; b < kBins; ++b) h[b] = below(kLowest + kWidth * (b + 1)) - below(kLowest + kWidth * b);
    return h;
}

/// The histogram of one chain's states, one for each step; those that are left out are none.
Histogram run_chain(const FailureStudy& study, std::uint64_t repeat, PrimaryCounts& counts) {
    Rng rng(study.seed, StreamPurpose::failure_study, repeat);
    Line line(study, rng);
    const PrimaryKernel kernel{study.failures, study.p_large};
    Histogram h{};
    double steps = 0;
    for (int i = 0; i < study.proposals; ++i) {
        if (!kernel.step(line, rng, counts, [](bool, double, bool) {})) continue;
        const double bin = std::floor((line.x() - kLowest) / kWidth);
        if (bin >= 0 && bin < kBins) h[static_cast<std::size_t>(bin)] += 1;
        steps += 1;
    }
    for (double& x : h) x /= std::max(1.0, steps);
    return h;
}

} // namespace

FailureStudyResult run_failure_study(const FailureStudy& study) {
    const Histogram expected = exact(study.target);
    Histogram sum{}, squares{};
    PrimaryCounts counts;
    for (int r = 0; r < study.repeats; ++r) {
        const Histogram h = run_chain(study, static_cast<std::uint64_t>(r), counts);
        for (std::size_t b = 0; b < kBins; ++b) {
            const double error = h[b] - expected[b];
            sum[b] += error;
            squares[b] += error * error;
        }
    }
    double total = 0, same = 0; // mean squares over bins
    for (std::size_t b = 0; b < kBins; ++b) {
        total += squares[b] / study.repeats / kBins;
        same += sum[b] * sum[b] / study.repeats / study.repeats / kBins;
    }
    // The mean over repeats still holds 1 / repeats of the variance.
    const double bias2 = std::max(0.0, (same * study.repeats - total) / (study.repeats - 1));
    const double proposals = static_cast<double>(counts.proposals());
    return {std::sqrt(total),
            std::sqrt(bias2),
            std::sqrt(total - bias2),
            static_cast<double>(counts.small.failed + counts.large.failed) / proposals,
            static_cast<double>(counts.small.accepted + counts.large.accepted + counts.delayed.accepted) / proposals,
            static_cast<double>(counts.remedied()) / proposals};
}

} // namespace keyhole
