// Which of the methods that were tried would leave the least error.
#pragma once

#include "methods/choice/method_trials.h"

#include <limits>
#include <vector>

namespace keyhole {

/// What a render has to keep to besides its time.
struct RankLimits {
    double samples = std::numeric_limits<double>::infinity(); ///< of a pixel, of methods without photons that take them
    double passes = 1; ///< that the time is cut into: maps of a pass have its photons alone
};

/// Errors of all, for so much time or work, and the best first.
void rank_methods(std::vector<TriedMethod>& tried, const TrialContext& c, double left, const RankLimits& limits = {});

} // namespace keyhole
