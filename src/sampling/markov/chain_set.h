// Many chains side by side.
#pragma once

#include "core/kronecker.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "sampling/markov/chain.h"
#include "sampling/markov/convergence.h"
#include "sampling/paths/path.h"

#include <algorithm>
#include <memory>
#include <span>

namespace keyhole {

/// The stream of chain `index`. The k-th points of all chains are one rank-1 lattice (Roberts' R2), shifted at random
/// for each k: together they cover the image evenly, so that every part of it has its turn.
///
/// Stratified among chains and not along one: what a chain draws next must not depend on what it drew before, of which
/// its state still knows. Each chain alone sees independent uniform points, as an exact transition needs.
class ChainStream final : public Rng {
  public:
    ChainStream(std::uint64_t seed, std::uint64_t index)
        : Rng(seed, StreamPurpose::chain, 2 * index), seed_(seed), index_(static_cast<double>(index)) {}

    std::array<double, 2> next_point() override {
        Rng shift(seed_, StreamPurpose::chain_points, round_++);
        const double x = kronecker(shift.next(), index_, kR2[0]);
        return {x, kronecker(shift.next(), index_, kR2[1])};
    }

  private:
    std::uint64_t seed_, round_ = 0;
    double index_;
};

/// What became of a set of chains.
struct ChainSummary {
    std::size_t chains = 0;
    std::uint64_t steps = 0;                 ///< of all chains
    Ledger ledger;                           ///< in the order of the mixture
    std::uint64_t longest_rejection_run = 0; ///< of any chain
    std::size_t stuck = 0;                   ///< chains that spent more than half of their steps at one state
    std::optional<ConvergenceDiagnostic> convergence;
    std::optional<GuidanceEffect> guidance; ///< where there are controls

    std::uint64_t steps_per_chain() const { return chains == 0 ? 0 : steps / chains; }
};

/// One chain from each seed, all equally long at any time. Their number is that of the seeds and never follows the
/// threads: the result is the same on any number of them.
class ChainSet {
  public:
    /// The mixtures must outlive the set. `control`: what the control chains use; the first kinds of `mixture`. Null:
    /// there are no controls. `first`: number of the first chain, where others run those before it.
    ChainSet(std::span<const Path> seeds, const Mixture<Path>& mixture, std::uint64_t seed,
             const Mixture<Path>* control = nullptr, std::int64_t first = 0)
        : chains_(seeds.size()) {
        if (control != nullptr) tally_.emplace(size(), first);
        parallel_for(size(), [&](std::int64_t c) {
            const auto i = static_cast<std::size_t>(c);
            chains_[i] = std::make_unique<Chain<Path, ChainStream>>(
                seeds[i], control != nullptr && is_control(first + c) ? *control : mixture,
                ChainStream(seed, static_cast<std::uint64_t>(first + c)));
        });
    }

    std::int64_t size() const { return static_cast<std::int64_t>(chains_.size()); }
    /// Steps that each chain has made.
    std::int64_t steps() const { return steps_; }

    /// Advances every chain by `steps` steps. Calls deposit(chain, path, weight), for different chains at once.
    template <class Deposit> void advance(std::int64_t steps, const RunContext& context, Deposit&& deposit) {
        parallel_for(size(), [&](std::int64_t c) {
            Chain<Path, ChainStream>& chain = *chains_[static_cast<std::size_t>(c)];
            for (std::int64_t i = 0; i < steps; ++i)
                chain.step([&](const Path& path, double weight) {
                    monitor_.add(c, path.image, weight);
                    if (tally_) tally_->add(c, path.image, weight);
                    deposit(c, path, weight);
                });
            context.advance(steps);
        });
        monitor_.end_round(steps);
        steps_ += steps;
    }

    ChainSummary summary() const {
        ChainSummary s;
        s.chains = chains_.size();
        s.steps = static_cast<std::uint64_t>(steps_ * size());
        for (const auto& chain : chains_) {
            merge(s.ledger, chain->ledger());
            s.longest_rejection_run = std::max(s.longest_rejection_run, chain->longest_rejection_run());
            s.stuck += 2 * chain->longest_rejection_run() > static_cast<std::uint64_t>(steps_) ? 1 : 0;
        }
        s.convergence = monitor_.diagnostic();
        if (tally_) s.guidance = tally_->effect();
        return s;
    }

  private:
    std::vector<std::unique_ptr<Chain<Path, ChainStream>>> chains_;
    ConvergenceMonitor monitor_;
    std::optional<GuidanceTally> tally_;
    std::int64_t steps_ = 0;
};

} // namespace keyhole
