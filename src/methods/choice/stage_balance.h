// How a render by chains shares its time between finding out the brightness and running them.
#pragma once

#include "core/render_stats.h"
#include "methods/choice/effort.h"

namespace keyhole {

/// The split with the least error for the time of a render with `balance`, by the errors that it had: squared errors
/// fall as the reciprocal of time, so the best times are as errors times the roots of times. Nothing changes where an
/// error isn't known.
StageBalance rebalance(const StageBalance& balance, const RenderStats& stats);

} // namespace keyhole
