// Chains in primary sample space, side by side, and their deposits.
#pragma once

#include "core/statistics.h"
#include "sampling/markov/convergence.h"
#include "sampling/primary/primary_kernel.h"
#include "sampling/primary/primary_start.h"
#include "sampling/primary/primary_state.h"

#include <functional>
#include <memory>

namespace keyhole {

/// One chain from each seed of each stratum, all equally long at any time. Their number never follows the threads: the
/// result is the same on any number of them.
///
/// Deposits combine the chain with its large steps, which are samples on their own account, by multiple importance
/// sampling (Kelemen et al. 2002, section 3.4): F / (I / b + p) for each step's expected value and for each large step.
class PrimaryChains {
  public:
    /// Told about each splat and the factor of its value. Called for different chains at once.
    using Deposit = std::function<void(const Splat&, double)>;

    /// `strata` must outlive the chains. `mis_of_large_steps` false: large steps deposit as any others, F b / I.
    /// `group`: chains of different groups have streams of their own.
    PrimaryChains(const std::vector<PrimaryStratum>& strata, std::uint64_t seed, bool mis_of_large_steps = true,
                  std::uint64_t group = 0);

    /// Advances every chain by `steps` steps, some of them after a change of technique where the stratum has that, not
    /// counting proposals that are left out. Without a first batch nothing is known of how many are: see
    /// PrimaryKernel::failures. Without `deposit` nothing is deposited. After a stop all chains end at the same,
    /// earlier step: a valid shorter round. @returns the steps that each chain has made, one at least
    std::int64_t advance(const PrimaryKernel& kernel, std::int64_t steps, const RunContext& context,
                         const Deposit& deposit = nullptr);

    std::int64_t size() const { return static_cast<std::int64_t>(chains_.size()); }
    /// Counted steps that each chain has made.
    std::int64_t steps() const { return steps_; }
    /// Over all of them.
    PrimaryCounts counts() const;
    const ChangeCounts& changes() const { return changes_; }
    /// Mean luminance over the window by independent samples and large steps, and its standard error.
    double brightness() const;
    double brightness_error() const;
    /// How far groups of chains agree on the brightness of parts of the image; see ConvergenceMonitor.
    std::optional<ConvergenceDiagnostic> convergence() const { return monitor_.diagnostic(); }
    /// Candidates with a value that was not a number.
    std::uint64_t broken() const;

  private:
    struct Chain {
        const std::size_t stratum;
        Rng rng;
        PrimaryState state;
        PrimaryCounts counts;
        ChangeCounts changes;
        RunningStats large;   ///< targets of large steps, of a round
        double stay = 0;      ///< weight that the state has gained and not yet deposited
        double candidate = 0; ///< weight that the candidate is to be deposited with
        int left_out = 0;     ///< proposals in a row

        Chain(const PathBuilder& builder, std::size_t of, const Rng& random)
            : stratum(of), rng(random), state(builder, rng) {}
        void begin_round() {
            counts = {};
            changes = {};
            large = {};
            left_out = 0;
        }
    };
    /// What a deposit is divided by.
    struct Weights {
        double brightness; ///< b
        double large;      ///< large steps for each counted step, where they deposit on their own account; else 0
        double scale;      ///< of chains in all to chains of this stratum
        double factor(double target) const { return scale / (target / brightness + large); }
    };
    struct Estimate {
        double mean, error; ///< of the brightness of a stratum
    };
    template <class Store> class DepositingChain;
    /// Calls make(n) for n steps of each chain at a time. @returns the steps that were made
    template <class Make>
    std::int64_t run_until_stopped(std::int64_t steps, const RunContext& context, const Make& make);
    Estimate estimate(std::size_t stratum) const;
    Weights weights(std::size_t stratum, const PrimaryKernel& kernel) const;

    const std::vector<PrimaryStratum>* strata_;
    bool mis_of_large_steps_;
    std::vector<std::unique_ptr<Chain>> chains_;
    std::vector<std::int64_t> members_; ///< chains of each stratum
    std::vector<RunningStats> large_;   ///< targets of large steps, by stratum
    std::vector<PrimaryCounts> counts_; ///< by stratum
    ChangeCounts changes_;
    ConvergenceMonitor monitor_;
    std::int64_t steps_ = 0;
    std::int64_t between_looks_ = 8; ///< steps of each chain, from one look at the stop to the next
};

} // namespace keyhole
