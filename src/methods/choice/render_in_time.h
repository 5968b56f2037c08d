// The best picture for a time.
#pragma once

#include "core/render_stats.h"
#include "core/settings.h"
#include "methods/render.h"

#include <optional>
#include <set>
#include <string>

namespace keyhole {

/// Renders for context.stop->seconds_left(), and uses all of it. Short trials show what each method costs in this scene
/// and how large its error is; for `auto` the one that promises the least error makes the picture. Where two without
/// photons are close, each gets a twelfth of the time first if that shows anything, and the rest goes to the one whose
/// error turns out smaller. The result is the mean of all renders but the trials, weighted by time and by the errors of
/// whole pictures, of which no pixel is more than a few thousandths: what biases it is as small. Where chains are run,
/// stage one and they share time so that their errors shrink together.
/// @param given settings that stay as they are.
/// @param share for its look(); all passes are done here.
/// @throws InputError where the time is too short for a method that is asked for by name, and as render().
RenderResult render_in_time(Scene& scene, const Settings& settings, const std::set<std::string>& given,
                            const RunContext& context, const UserPathFile& user_paths = {},
                            const WorkPartition& share = {});

/// How a time is filled by passes that others can go on from.
struct PassesInTime {
    Settings settings;             ///< of a render with as many passes as fit, by one method
    std::optional<double> seconds; ///< that a pass is expected to take, where it is more than rounds of samples
    RenderStats stats;             ///< what it took to choose them, and what was chosen
};

/// Passes for render(), by the method that promises the least error: as short as those that render_in_time() fills a
/// time with, so that the first is done well before context.stop. settings.passes stays as it is.
/// @throws InputError as render().
PassesInTime passes_in_time(Scene& scene, const Settings& settings, const std::set<std::string>& given,
                            const RunContext& context, const UserPathFile& user_paths);

} // namespace keyhole
