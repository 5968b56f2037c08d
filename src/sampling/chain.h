// The one place that accepts or rejects. Knows no rendering.
#pragma once

#include "sampling/ledger.h"
#include "sampling/mixture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace keyhole {

/// A Metropolis-Hastings chain (Metropolis et al. 1953, Hastings 1970) over `State`, which has a member
/// `double target`. Invariant: state().target > 0. Not thread-safe; each chain has a random stream of its own, an Rng.
template <class State, class Stream = Rng> class Chain {
  public:
    /// `mixture` must outlive the chain. `initial.target` must be positive.
    Chain(State initial, const Mixture<State>& mixture, Stream rng)
        : state_(std::move(initial)), mixture_(&mixture), rng_(rng), ledger_(mixture.size()) {}

    const State& state() const { return state_; }
    const Ledger& ledger() const { return ledger_; }
    /// Most steps that the chain ever stayed where it was.
    std::uint64_t longest_stay() const { return longest_stay_; }

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
        const double a = candidate ? acceptance(*candidate, k, entry) : 0.0;
        if (!candidate) ++entry.failed[static_cast<std::size_t>(why)];
        if (a < 1) deposit_state(1 - a, deposit);
        if (a > 0) {
            deposit(std::as_const(*candidate), a);
            entry.deposited += a;
        }
        if (!(a > 0)) return false;
        const bool accepted = rng_.next() < a;
        ++(accepted ? entry.accepted : entry.rejected);
        if (accepted) state_ = std::move(*candidate);
        return accepted;
    }

    /// min(1, [f(y) / T(x->y)] / [f(x) / T(y->x)]); 0, and counted, where that is zero or not a finite number.
    double acceptance(const State& y, std::size_t k, LedgerEntry& entry) const {
        if (y.target == 0) {
            ++entry.zero;
            return 0;
        }
        const double ratio = mixture_->acceptance_ratio(state_, y, k);
        if (ratio > 0 && std::isfinite(ratio)) return std::min(ratio, 1.0);
        ++(ratio == 0 ? entry.rejected : entry.nan);
        return 0;
    }

    template <class Deposit> void deposit_state(double weight, Deposit&& deposit) {
        deposit(std::as_const(state_), weight);
        if (maker_) ledger_[*maker_].deposited += weight;
    }

    bool moved(bool accepted) {
        stay_ = accepted ? 0 : stay_ + 1;
        longest_stay_ = std::max(longest_stay_, stay_);
        return accepted;
    }

    State state_;
    const Mixture<State>* mixture_;
    Stream rng_;
    Ledger ledger_;
    std::optional<std::size_t> maker_; ///< the kind that made the state; none for the initial one
    std::uint64_t stay_ = 0, longest_stay_ = 0;
};

} // namespace keyhole
