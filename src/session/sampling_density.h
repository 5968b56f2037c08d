// Adaptive sampling: where the picture gets more samples than elsewhere.
#pragma once

#include "core/statistics.h"
#include "film/pixel_sums.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keyhole {

/// Samples of each pixel over the mean of all, decided once, by the noise of a pilot: rounds of one sample of every
/// pixel. The squared errors of pixels, each relative to its light, add up to the least where samples go as the root of
/// the relative variance of one; bounds hold what a pilot can't have seen.
///
/// What a pixel gets is told by the pixels around it alone (leave-one-out), so that pilots count like all other
/// samples: a pixel's mean stays unbiased where its samples say nothing about how many there are. Were they counted and
/// asked, pixels whose pilot missed what is bright would stop at that, and be too dark (Kirk and Arvo, "Unbiased
/// sampling techniques for image synthesis", 1991).
///
/// Few samples say little about a variance that is made by a few bright ones. So the pilot has two halves, and how many
/// pixels around each are asked, or whether any, is what does best on the half that wasn't asked.
class SamplingDensity {
  public:
    /// @param width,height of the picture in pixels, at least 1.
    SamplingDensity(int width, int height);

    /// A sample of the pilot, of the luminance [W/(m^2 sr)] of a pixel; pixels are counted row by row. Calls for
    /// different pixels may run at once.
    void add(std::size_t pixel, double luminance, Half half) {
        pilot_[static_cast<std::size_t>(half)][pixel].add(luminance);
    }
    /// The pilot is over. Each half has two samples of a pixel at least.
    void decide();
    bool is_decided() const { return !density_.empty(); }

    /// Samples of a pixel over the mean of all pixels. 1 until it is decided.
    double at(std::size_t pixel) const { return is_decided() ? static_cast<double>(density_[pixel]) : 1; }
    /// The squared error that samples of pixels leave over that of as many even ones, as the halves of the pilot
    /// predict it of each other: 1 where the density is even.
    double error_over_even() const { return error_over_even_; }

    /// How many samples a pixel has before round number `round` of those that follow the pilot: at(pixel) of each
    /// round, rounded. `shift` in [0,1), one number for a pixel, says when its next sample is due: over all shifts the
    /// mean is at(pixel) * round.
    std::int64_t samples_before(std::size_t pixel, std::int64_t round, double shift) const;

  private:
    using Stats = std::vector<RunningStats>; // by pixel

    int width_, height_;
    std::array<Stats, 2> pilot_;
    std::vector<float> density_;
    double error_over_even_ = 1;
};

} // namespace keyhole
