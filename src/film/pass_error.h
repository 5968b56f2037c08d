// How far the mean over passes still is from where it goes.
#pragma once

#include "film/accumulation_buffer.h"

#include <vector>

namespace keyhole {

/// Watches a picture from pass to pass and estimates the noise of the mean from how the passes differ: they are
/// independent. What all of them share, such as the bias of a lookup's radius, it can't see.
class PassError {
  public:
    /// To be called after each pass, with the mean over all so far.
    void add(const AccumulationBuffer& mean);

    std::int64_t passes() const { return passes_; }

    /// Root of the mean over pixels of var(mean) / (mean^2 + 0.01 Mean^2), on luminance, `Mean` that of the picture:
    /// the root of what `keyhole diff` calls relmse. Infinite before the second pass.
    double relative() const;

    /// What is known by pixel, as it stands in memory, and back. `passes`: calls of add() until then.
    AccumulatorState words() const;
    void set_words(const AccumulatorState& words, std::int64_t passes);

  private:
    struct Pixel {
        double mean = 0, m2 = 0;
    };
    std::vector<Pixel> pixels_;
    std::int64_t passes_ = 0;
};

} // namespace keyhole
