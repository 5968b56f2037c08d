// Which of the methods that were tried would leave the least error.
#pragma once

#include "methods/choice/method_trials.h"

#include <vector>

namespace keyhole {

/// Errors of all, for so much time or work, and the best first.
void rank_methods(std::vector<TriedMethod>& tried, const TrialContext& c, double left);

} // namespace keyhole
