// What `auto` stands for in a render without a time.
#pragma once

#include "methods/choice/method_trials.h"

#include <string>

namespace keyhole {

struct ChosenByWork {
    Settings settings; ///< with the method, and as much work as is asked for
    std::string why;   ///< for the record; empty: no trial was done
};

/// By trials of a known amount of work. @throws Interrupted
ChosenByWork choose_by_work(const TrialContext& c);

} // namespace keyhole
