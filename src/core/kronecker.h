// Kronecker sequences: the multiples of an irrational number modulo 1, which fill [0,1) evenly however many there are.
#pragma once

#include "core/rng.h"

#include <array>
#include <cmath>

namespace keyhole {

/// Steps of Roberts' R2 sequence ("The unreasonable effectiveness of quasirandom sequences", 2018): the two dimensions
/// together fill the unit square evenly.
inline constexpr std::array<double, 2> kR2{0.7548776662466927, 0.5698402909980532};

/// Member `i` of the sequence with step `alpha` that starts at `shift`, in [0,1).
inline double kronecker(double shift, double i, double alpha) {
    const double x = shift + i * alpha;
    return x - std::floor(x);
}

/// The first numbers of sample i come from Kronecker sequences, frac(shift + i alpha), with a random shift of the
/// pixel's own: position in the pixel (Roberts' R2), lens, choice of a light and a point on it, and what the path does
/// next. The others are random. Every number is uniform whatever i, so estimates stay unbiased; samples of a pixel
/// share out the work.
class LatticeSource final : public SampleSource {
  public:
    /// `pixel` and `sample` count within a purpose; `rest` is the sample's own stream.
    LatticeSource(const Rng& pixel, std::uint64_t sample, const Rng& rest)
        : shift_(pixel), rest_(rest), sample_(static_cast<double>(sample)) {}

    double next() override {
        if (dimension_ == kAlpha.size()) return rest_.next();
        return kronecker(shift_.next(), sample_, kAlpha[dimension_++]);
    }

  private:
    // R2; square roots of primes, which are independent over the rationals, without those close above an integer:
    // multiples of such a fraction fill the interval late.
    static constexpr std::array<double, 16> kAlpha{
        kR2[0],
        kR2[1],
        0.4142135623730950, // 2
        0.7320508075688772, // 3
        0.6180339887498949, // 5, as the golden ratio
        0.6457513110645906, // 7
        0.3166247903553998, // 11
        0.6055512754639892, // 13
        0.3588989435406735, // 19
        0.7958315233127191, // 23
        0.3851648071345037, // 29
        0.5677643628300215, // 31
        0.4031242374328485, // 41
        0.5574385243020004, // 43
        0.8102496759066540, // 61
        0.1853527718724504, // 67
    };
    Rng shift_, rest_;
    double sample_;
    std::size_t dimension_ = 0;
};

/// Numbers for several samples of emitters at one place, which share out the unit cube: those of sample j are those of
/// sample 0, j steps of a Kronecker sequence on. They take four numbers of the source, however many samples there are.
class SharedNumbers final : public SampleSource {
  public:
    explicit SharedNumbers(SampleSource& rest) : rest_(rest) { rest.fill(first_); }
    void begin(std::uint32_t sample) {
        sample_ = sample;
        dimension_ = 0;
    }
    double next() override {
        if (dimension_ == first_.size()) return rest_.next();
        const std::size_t d = dimension_++;
        return kronecker(first_[d], sample_, kAlpha[d]);
    }

  private:
    // The choice of an emitter, of a part of it, and a point there.
    static constexpr std::array<double, 4> kAlpha{0.4142135623730950, 0.7320508075688772, kR2[0], kR2[1]};
    std::array<double, kAlpha.size()> first_{};
    SampleSource& rest_;
    std::uint32_t sample_ = 0;
    std::size_t dimension_ = 0;
};

} // namespace keyhole
