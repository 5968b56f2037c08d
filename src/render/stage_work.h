// What the time that the stages of a render take depends on.
#pragma once

#include "core/settings.h"

#include <string_view>

namespace keyhole {

/// A number that the time of a stage in all passes is about proportional to, from one render of a scene to another by
/// the same method; 1 where the settings have no say. `stage` is a StageStats::name.
/// @param settings with the method that is run in place of `auto`.
/// @param pixels of the picture.
double stage_work(std::string_view stage, const Settings& settings, double pixels);

} // namespace keyhole
