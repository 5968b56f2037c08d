// A chart of methods against time and memory: runs, references, figures.
#pragma once

#include "cli/chart/options.h"
#include "core/progress.h"

namespace keyhole {

/// Makes what is missing of a chart and writes all that its folder holds. Returns an exit code. What a run gave is kept
/// at once, so that the next call goes on where this one was stopped.
/// @throws InputError for scenes, settings or pictures that can't be used.
int make_chart(const ChartOptions& options, const StopToken& stop);

} // namespace keyhole
