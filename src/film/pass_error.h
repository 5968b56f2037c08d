// How far the mean over passes still is from where it goes.
#pragma once

#include "film/film.h"

#include <vector>

namespace keyhole {

/// Watches a film from pass to pass and estimates the noise of the mean from how the passes differ: they are
/// independent. What all of them share, such as the bias of a lookup's radius, it can't see.
class PassError {
  public:
    /// To be called after each pass.
    void add(const Film& film);

    /// Root of the mean over pixels of var(mean) / (mean^2 + 0.01 Mean^2), on luminance, `Mean` that of the picture:
    /// the root of what `keyhole diff` calls relmse. Infinite before the second pass.
    double relative() const;

  private:
    struct Pixel {
        double sum = 0;     // of the film when last seen
        double samples = 0; // likewise
        double mean = 0, m2 = 0;
    };
    std::vector<Pixel> pixels_;
    std::int64_t passes_ = 0;
};

} // namespace keyhole
