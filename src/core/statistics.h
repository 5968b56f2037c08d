// Running mean and variance.
#pragma once

#include <cmath>
#include <cstdint>

namespace keyhole {

/// Mean and variance of a stream of numbers (Welford 1962). Merging in a fixed order is reproducible bit for bit.
class RunningStats {
  public:
    void add(double x) {
        ++n_;
        const double d = x - mean_;
        mean_ += d / static_cast<double>(n_);
        m2_ += d * (x - mean_);
    }

    void merge(const RunningStats& o) {
        if (o.n_ == 0) return;
        const auto na = static_cast<double>(n_), nb = static_cast<double>(o.n_);
        const double d = o.mean_ - mean_;
        mean_ += d * nb / (na + nb);
        m2_ += o.m2_ + d * d * na * nb / (na + nb);
        n_ += o.n_;
    }

    std::uint64_t count() const { return n_; }
    double mean() const { return mean_; }
    /// Unbiased variance of one sample; 0 below two samples.
    double variance() const { return n_ < 2 ? 0.0 : m2_ / static_cast<double>(n_ - 1); }
    /// Standard error of the mean; 0 below two samples.
    double standard_error() const { return n_ < 2 ? 0.0 : std::sqrt(variance() / static_cast<double>(n_)); }

  private:
    std::uint64_t n_ = 0;
    double mean_ = 0, m2_ = 0;
};

/// Share of a time that the first of two parts of a work should get, so that their squared errors, which fall as the
/// reciprocals of their times, add up to the least. Both are told as squared error times time; one is positive.
inline double best_share_of_time(double first, double second) {
    const double a = std::sqrt(first), b = std::sqrt(second);
    return a / (a + b);
}

} // namespace keyhole
