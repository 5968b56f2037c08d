// Time and rays of a stage.
#pragma once

#include "core/render_stats.h"

#include <chrono>

namespace keyhole {

/// Adds to the line of its stage in the statistics when it goes out of scope.
class StageClock {
  public:
    StageClock(RenderStats& stats, const Stage& stage);
    ~StageClock();
    StageClock(const StageClock&) = delete;
    StageClock& operator=(const StageClock&) = delete;

  private:
    RenderStats& stats_;
    const Stage& stage_;
    std::chrono::steady_clock::time_point start_;
    double cpu_;
    std::uint64_t rays_;
};

} // namespace keyhole
