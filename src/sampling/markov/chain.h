// A Metropolis-Hastings chain, and what became of each of its proposals. Knows no rendering.
#pragma once

#include "sampling/markov/acceptance.h"
#include "sampling/markov/mixture.h"

#include <chrono>
#include <cstdint>
#include <utility>

namespace keyhole {

/// Counts for one kind of proposal: proposed = failed + zero + nan + rejected + accepted.
struct LedgerEntry {
    std::uint64_t proposed = 0;
    std::array<std::uint64_t, kFailures> failed{}; ///< by Failure
    std::uint64_t zero = 0;                        ///< evaluated, and the target was 0
    std::uint64_t nan = 0;                         ///< acceptance was not a number: rejected
    std::uint64_t rejected = 0, accepted = 0;
    double deposited = 0; ///< weight that states of this kind's making left, until another candidate was accepted
    double seconds = 0;   ///< wall time of the thread that ran the steps

    LedgerEntry& operator+=(const LedgerEntry& o) {
        proposed += o.proposed;
        for (std::size_t i = 0; i < kFailures; ++i) failed[i] += o.failed[i];
        zero += o.zero;
        nan += o.nan;
        rejected += o.rejected;
        accepted += o.accepted;
        deposited += o.deposited;
        seconds += o.seconds;
        return *this;
    }
};

/// One entry for each kind of a mixture, in its order.
using Ledger = std::vector<LedgerEntry>;

inline void merge(Ledger& into, const Ledger& other) {
    if (into.size() < other.size()) into.resize(other.size());
    for (std::size_t k = 0; k < other.size(); ++k) into[k] += other[k];
}

/// A Metropolis-Hastings chain (Metropolis et al. 1953, Hastings 1970) over `State`, which has a member
/// `double target`. Invariant: state().target > 0. Not thread-safe; each chain has a random stream of its own, an Rng.
template <class State, class Stream = Rng> class Chain {
  public:
    /// `mixture` must outlive the chain. `initial.target` must be positive.
    Chain(State initial, const Mixture<State>& mixture, Stream rng)
        : state_(std::move(initial)), mixture_(&mixture), rng_(rng), ledger_(mixture.size()) {}

    const State& state() const { return state_; }
    const Ledger& ledger() const { return ledger_; }
    /// Most steps in a row after which the state was the same.
    std::uint64_t longest_rejection_run() const { return longest_run_; }

    /// One step. Deposits expected values: deposit(x, 1 - a) for the state before it, then deposit(y, a) for the
    /// candidate, each only where its weight is positive. Returns whether the candidate became the state.
    template <class Deposit> bool step(Deposit&& deposit) {
        const auto start = std::chrono::steady_clock::now();
        const auto k = mixture_->choose(state_, rng_);
        if (!k) {
            deposit_state(1, deposit);
            return moved(false);
        }
        LedgerEntry& entry = ledger_[*k];
        const bool accepted = try_kind(*k, entry, deposit);
        if (accepted) maker_ = k;
        entry.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return moved(accepted);
    }

  private:
    template <class Deposit> bool try_kind(std::size_t k, LedgerEntry& entry, Deposit&& deposit) {
        ++entry.proposed;
        Failure why{};
        auto candidate = mixture_->kind(k).propose(state_, rng_, why);
        if (!candidate) ++entry.failed[static_cast<std::size_t>(why)];
        const double a = candidate ? acceptance_of(*candidate, k, entry) : 0.0;
        const bool accepted = deposit_and_accept(a, rng_, [&](bool of_candidate, double weight) {
            if (!of_candidate) return deposit_state(weight, deposit);
            deposit(std::as_const(*candidate), weight);
            entry.deposited += weight;
        });
        if (a > 0) ++(accepted ? entry.accepted : entry.rejected);
        if (accepted) state_ = std::move(*candidate);
        return accepted;
    }

    /// Counts what can't be accepted.
    double acceptance_of(const State& y, std::size_t k, LedgerEntry& entry) const {
        if (y.target == 0) {
            ++entry.zero;
            return 0;
        }
        const double ratio = mixture_->acceptance_ratio(state_, y, k), a = acceptance(ratio);
        if (!(a > 0)) ++(ratio == 0 ? entry.rejected : entry.nan);
        return a;
    }

    template <class Deposit> void deposit_state(double weight, Deposit&& deposit) {
        deposit(std::as_const(state_), weight);
        if (maker_) ledger_[*maker_].deposited += weight;
    }

    bool moved(bool accepted) {
        run_ = accepted ? 0 : run_ + 1;
        longest_run_ = std::max(longest_run_, run_);
        return accepted;
    }

    State state_;
    const Mixture<State>* mixture_;
    Stream rng_;
    Ledger ledger_;
    std::optional<std::size_t> maker_;        ///< the kind that made the state; none for the initial one
    std::uint64_t run_ = 0, longest_run_ = 0; ///< of rejections
};

} // namespace keyhole
