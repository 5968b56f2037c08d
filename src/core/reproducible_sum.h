// Sums of numbers of any size that don't depend on the order or the grouping of their terms.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace keyhole {

/// `N` sums (after Demmel and Nguyen 2015, "Parallel reproducible summation"). The line of exponents is cut into bins
/// of 32 bits at places fixed once and for all, and every term into its parts in them; parts in the bin of the largest
/// term and in the next lower one are added up as integers, what lies below is dropped. So any order of terms, and any
/// grouping into sums that are merged later, gives the same bits; and what is dropped of a term is below 2^-32 of the
/// largest. Terms must be finite; those below 2^-960 in size count as 0. Up to 2^31 terms.
///
/// Plain memory, that may be written to a file and read again. Not thread-safe.
template <std::size_t N> class ReproducibleSums {
  public:
    ReproducibleSums() { bins_.fill(kLowest); }

    /// Adds `x` to sum `i`.
    void add(std::size_t i, double x) {
        const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52U & 0x7FFU) - 1023;
        if (exponent < kBits * kLowest) return;
        raise(i, exponent >> 5);
        const double scaled = x * power_of_two(-kBits * bins_[i]);
        const auto high = static_cast<std::int64_t>(scaled);
        high_[i] += high;
        low_[i] += static_cast<std::int64_t>((scaled - static_cast<double>(high)) * 0x1p32);
    }

    /// Adds the terms of another sum.
    void merge(const ReproducibleSums& o) {
        for (std::size_t i = 0; i < N; ++i) {
            raise(i, o.bins_[i]);
            if (o.bins_[i] == bins_[i]) {
                high_[i] += o.high_[i];
                low_[i] += o.low_[i];
            } else if (o.bins_[i] == bins_[i] - 1) {
                low_[i] += o.high_[i];
            }
        }
    }

    double value(std::size_t i) const {
        return (static_cast<double>(high_[i]) + static_cast<double>(low_[i]) * 0x1p-32) *
               power_of_two(kBits * bins_[i]);
    }

  private:
    static constexpr int kBits = 32; // of a bin; bin b holds what is a multiple of 2^(32 b)
    static constexpr std::int8_t kLowest = -30;

    static double power_of_two(int exponent) {
        return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52U);
    }

    /// Makes room for terms in `bin`.
    void raise(std::size_t i, int bin) {
        if (bin <= bins_[i]) return;
        low_[i] = bin == bins_[i] + 1 ? high_[i] : 0;
        high_[i] = 0;
        bins_[i] = static_cast<std::int8_t>(bin);
    }

    std::array<std::int64_t, N> high_{}, low_{};    // in units of 2^(32 bin) and 2^(32 (bin - 1))
    std::array<std::int8_t, (N + 7) / 8 * 8> bins_; // a multiple of 8 bytes, so that there is no padding
};

} // namespace keyhole
