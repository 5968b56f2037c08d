// What a pixel's samples add up to, in all and in either half of them.
#pragma once

#include "core/reproducible_sum.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace keyhole {

/// Samples are told apart by the unit of work that they belong to, so that halves are independent of each other.
enum class Half : std::uint8_t { first, second };

inline Half half_of(std::int64_t unit) { return unit % 2 == 0 ? Half::first : Half::second; }

/// Sums of `N` channels that don't depend on the order of samples, nor on how they were shared out among sums that are
/// merged. Plain memory.
template <std::size_t N> class PixelSums {
  public:
    using Channels = std::array<double, N>;

    /// Values must be finite.
    void add(const Channels& values, Half half) {
        const double sign = half == Half::first ? 1 : -1;
        for (std::size_t c = 0; c < N; ++c) {
            sums_.add(c, values[c]);
            differences_.add(c, sign * values[c]);
        }
        ++samples_;
        if (half == Half::first) ++first_;
    }

    void merge(const PixelSums& other) {
        sums_.merge(other.sums_);
        differences_.merge(other.differences_);
        samples_ += other.samples_;
        first_ += other.first_;
    }

    std::uint64_t samples() const { return samples_; }

    /// Of all samples; 0 without any.
    Channels means() const {
        Channels mean{};
        if (samples_ == 0) return mean;
        for (std::size_t c = 0; c < N; ++c) mean[c] = sums_.value(c) / static_cast<double>(samples_);
        return mean;
    }

    /// What the means A and B of the halves differ in, times sqrt(a b) / (a + b), a and b being how many samples they
    /// have: its square is an unbiased estimate of the variance of the mean M of all, with which it is uncorrelated.
    /// So M + D and M - D are two uncorrelated estimates of the pixel, each with twice the variance of M. 0 where a
    /// half is empty.
    Channels half_differences() const {
        Channels difference{};
        const auto a = static_cast<double>(first_), b = static_cast<double>(samples_ - first_);
        if (a == 0 || b == 0) return difference;
        for (std::size_t c = 0; c < N; ++c) {
            const double sum = sums_.value(c), of_halves = differences_.value(c);
            difference[c] = ((sum + of_halves) / a - (sum - of_halves) / b) / 2 * std::sqrt(a * b) / (a + b);
        }
        return difference;
    }

  private:
    ReproducibleSums<N> sums_;
    ReproducibleSums<N, std::int32_t, 12>
        differences_; // first half minus second: an estimate of noise needs few digits
    std::uint64_t samples_ = 0, first_ = 0;
};

} // namespace keyhole
