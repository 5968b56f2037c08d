// What the methods that run chains tell of them, and when they raise an alarm.
#pragma once

#include "core/render_stats.h"
#include "sampling/brightness.h"
#include "sampling/chain_set.h"

namespace keyhole {

/// Stage one, with its figures in `stats`.
StageOne measure_brightness(const Scene& scene, const StageOneSettings& settings, RenderStats& stats,
                            const RunContext& context);

/// Warns where the brightness in `stats` is zero or poorly known; `stopped`: stage one was cut short.
void warn_of_brightness(RenderStats& stats, bool stopped);

/// Puts the ledger and the figures of a set of chains into `stats`, and warns where the picture can't be trusted:
/// chains that stick, and groups of chains that disagree.
void report_chains(RenderStats& stats, const Mixture<Path>& mixture, const ChainSummary& chains);

} // namespace keyhole
