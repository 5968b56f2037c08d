// How much effort a time is enough for.
#pragma once

#include "methods/choice/effort.h"
#include "methods/choice/experience.h"

#include <set>
#include <string>

namespace keyhole {

/// The most effort of which a render by the method of `cost` is predicted to take at most `seconds`; next to none where
/// that is too much already. Where what was `given` takes most of that time, the rest gets two fifths of it all the
/// same.
double affordable_effort(const Experience& cost, const Settings& settings, const std::set<std::string>& given,
                         const StageBalance& balance, double pixels, double seconds);

/// What the settings that were `given` add to the time of a render with next to no effort [s].
double cost_of_given(const Experience& cost, const Settings& settings, const std::set<std::string>& given,
                     double pixels);

} // namespace keyhole
