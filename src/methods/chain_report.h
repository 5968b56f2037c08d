// What the methods that run chains tell of them, and when they raise an alarm.
#pragma once

#include "core/render_stats.h"
#include "sampling/brightness.h"
#include "sampling/markov/chain_set.h"

namespace keyhole {

/// Collects what is to be told of one pass after the other.
class ChainReports {
  public:
    /// Stage one of a pass, with its figures in `stats`. B of a pass is its own: passes are independent, and the mean
    /// over them has the error of all samples of B together.
    StageOne measure_brightness(const Scene& scene, const StageOneSettings& settings, RenderStats& stats,
                                const RunContext& context);

    /// Puts the ledger and the figures of the chains of a pass into `stats`. The first pass warns where the picture
    /// can't be trusted: chains that stick, and groups of chains that disagree. The others add to the ledger.
    void add(const Mixture<Path>& mixture, const ChainSummary& chains, RenderStats& stats);

    /// Warns where the brightness of all passes is zero or poorly known.
    void finish(RenderStats& stats) const;

  private:
    RunningStats brightness_; // over all passes
    bool stopped_ = false;    // in stage one
    bool first_ = true;
};

/// Says how far groups of chains agree, where that is known.
void report_convergence(RenderStats& stats, const std::optional<ConvergenceDiagnostic>& found);

/// Warns where groups of chains disagree, or `steps` of each were too few to tell.
void warn_of_convergence(RenderStats& stats, const std::optional<ConvergenceDiagnostic>& found, std::int64_t steps);

/// Adds the ledgers of a later pass.
void add_ledger(std::vector<ProposalStats>& lines, const std::vector<ProposalStats>& more);

/// Adds the ledger of a later pass to that in `stats`; its other figures take the place of those of the passes before.
void add_pass(RenderStats& stats, RenderStats pass);

} // namespace keyhole
