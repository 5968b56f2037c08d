// Sums that don't depend on the order of their terms.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>

namespace keyhole {

/// A sum in fixed point, in units of 2^-30. Integers add up to the same whatever the order, so many threads may add at
/// once and the result is the same bit for bit. Holds sums below 8.5e9 in size.
class FixedSum {
  public:
    /// Thread-safe. `x` must be finite.
    void add(double x) {
        const double units = x * kUnit; // rounded by hand: std::llround() is a call
        units_.fetch_add(static_cast<std::int64_t>(units + std::copysign(0.5, units)), std::memory_order_relaxed);
    }

    double value() const { return static_cast<double>(units_.load(std::memory_order_relaxed)) / kUnit; }

    /// The sum so far; the next one begins at 0.
    double take() { return static_cast<double>(units_.exchange(0, std::memory_order_relaxed)) / kUnit; }

  private:
    static constexpr double kUnit = 0x1p30;
    std::atomic<std::int64_t> units_{0};
};

} // namespace keyhole
