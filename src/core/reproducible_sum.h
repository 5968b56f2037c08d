// Sums that don't depend on the order of their terms. There are two. FixedSum is what many threads add to at once: one
// atomic integer, and so of a fixed range, which splats of weights about 1 keep to. ReproducibleSums take numbers of
// any size exactly enough to be saved, sent and merged, with three numbers for each sum, which no atomic operation
// changes at once; they would cost splats twice the memory and a lock.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace keyhole {

/// A sum in fixed point, in units of 2^-30. Integers add up to the same whatever the order, so many threads may add at
/// once and the result is the same bit for bit. Holds sums below 8.5e9 in size.
class FixedSum {
  public:
    /// Thread-safe. `x` must be finite; no more of it counts than a sum may hold.
    void add(double x) {
        const double units = std::clamp(x * kUnit, -kMost, kMost); // rounded by hand: std::llround() is a call
        units_.fetch_add(static_cast<std::int64_t>(units + std::copysign(0.5, units)), std::memory_order_relaxed);
    }

    double value() const { return static_cast<double>(units_.load(std::memory_order_relaxed)) / kUnit; }

    /// The sum so far; the next one begins at 0.
    double take() { return static_cast<double>(units_.exchange(0, std::memory_order_relaxed)) / kUnit; }

  private:
    static constexpr double kUnit = 0x1p30, kMost = 0x1p62;
    std::atomic<std::int64_t> units_{0};
};

/// `N` sums (after Demmel and Nguyen 2015, "Parallel reproducible summation"). The line of exponents is cut into bins
/// of `Bits` bits at places fixed once and for all, and every term into its parts in them; parts in the bin of the
/// largest term and in the next lower one are added up as integers, what lies below is dropped. So any order of terms,
/// and any grouping into sums that are merged later, gives the same bits; and what is dropped of a term is below
/// 2^-Bits of the largest. Terms must be finite; those below 2^-960 in size count as 0. As many terms as an `Integer`
/// has bits beyond `Bits` and the sign: 2^31 of the default. More of one sign may wrap around.
///
/// Plain memory, that may be written to a file and read again. Not thread-safe.
template <std::size_t N, class Integer = std::int64_t, int Bits = 32> class ReproducibleSums {
  public:
    ReproducibleSums() { bins_.fill(kLowest); }

    /// Adds `x` to sum `i`.
    void add(std::size_t i, double x) {
        const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52U & 0x7FFU) - 1023;
        if (exponent < Bits * kLowest) return;
        raise(i, (exponent - Bits * kLowest) / Bits + kLowest);
        const double scaled = x * power_of_two(-Bits * bins_[i]);
        const auto high = static_cast<Integer>(scaled);
        add_to(high_[i], high);
        add_to(low_[i], static_cast<Integer>((scaled - static_cast<double>(high)) * power_of_two(Bits)));
    }

    /// Adds the terms of another sum.
    void merge(const ReproducibleSums& o) {
        for (std::size_t i = 0; i < N; ++i) {
            raise(i, o.bins_[i]);
            if (o.bins_[i] == bins_[i]) {
                add_to(high_[i], o.high_[i]);
                add_to(low_[i], o.low_[i]);
            } else if (o.bins_[i] == bins_[i] - 1) {
                add_to(low_[i], o.high_[i]);
            }
        }
    }

    double value(std::size_t i) const {
        return (static_cast<double>(high_[i]) + static_cast<double>(low_[i]) * power_of_two(-Bits)) *
               power_of_two(Bits * bins_[i]);
    }

  private:
    static constexpr std::int8_t kLowest = -960 / Bits; // bin b holds what is a multiple of 2^(Bits b)
    static_assert(960 % Bits == 0);

    static double power_of_two(int exponent) {
        return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52U);
    }

    /// Wraps around, as signed addition must not.
    static void add_to(Integer& sum, Integer term) {
        using Unsigned = std::make_unsigned_t<Integer>;
        sum = static_cast<Integer>(static_cast<Unsigned>(sum) + static_cast<Unsigned>(term));
    }

    /// Makes room for terms in `bin`.
    void raise(std::size_t i, int bin) {
        if (bin <= bins_[i]) return;
        low_[i] = bin == bins_[i] + 1 ? high_[i] : 0;
        high_[i] = 0;
        bins_[i] = static_cast<std::int8_t>(bin);
    }

    std::array<Integer, N> high_{}, low_{};         // in units of 2^(Bits bin) and 2^(Bits (bin - 1))
    std::array<std::int8_t, (N + 7) / 8 * 8> bins_; // a multiple of 8 bytes, so that there is no padding
};

} // namespace keyhole
