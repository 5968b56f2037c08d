// What chains in primary sample space tell of themselves.
#pragma once

#include "core/render_stats.h"
#include "sampling/primary/p_large.h"

namespace keyhole {

/// What the rule for large steps said, and the probability `p` that is used.
void report_large_steps(const LargeStepRule& rule, double p, RenderStats& stats);

/// The ledger of so many chains. Replaces that in `stats`.
void report_steps(const PrimaryCounts& counts, std::int64_t chains, RenderStats& stats);

/// Warns where so many candidates, of all passes, had a value that is not a number.
void warn_of_broken(RenderStats& stats, std::uint64_t broken);

} // namespace keyhole
