// One chain in primary sample space, and its deposits.
#pragma once

#include "core/statistics.h"
#include "sampling/primary/primary_kernel.h"

#include <utility>

namespace keyhole {

/// `State`: see PrimaryStateOf. Refers to itself: neither copied nor moved.
template <class State> struct PrimaryChain {
    Rng rng;
    State state;
    PrimaryCounts counts;
    RunningStats large; ///< targets of large steps, of a round
    double stay = 0;    ///< weight that the state has gained and not yet deposited

    template <class Builder>
    PrimaryChain(const Builder& builder, const Rng& random) : rng(random), state(builder, rng) {}

    /// Those that failed have target 0. `failed`: large steps that had failed before the round.
    void count_failed_large_steps(std::uint64_t failed) {
        for (std::uint64_t i = failed; i < counts.large.failed; ++i) large.add(0);
    }
};

/// A chain as the kernel's space. What it stays at a state is deposited at once when it leaves, together with what the
/// state brought as a candidate: most of the work of a deposit doesn't depend on its weight. Large steps are samples on
/// their own account, too (Kelemen et al. 2002, section 3.4), where `large_count` says so.
///
/// `Store`: store(sample, weight), for positive weights.
template <class State, class Store> class DepositingChain {
  public:
    using Sample = typename State::Sample;

    DepositingChain(PrimaryChain<State>& chain, bool large_count, Store store)
        : chain_(&chain), large_count_(large_count), store_(std::move(store)) {}

    double propose(Step step) {
        drop_candidate();
        return chain_->state.propose(step);
    }
    double target() const { return chain_->state.target(); }
    void accept() {
        leave(chain_->state.sample());
        chain_->stay = std::exchange(candidate_, 0);
        chain_->state.accept();
    }
    /// For the kernel.
    void operator()(bool candidate, double weight, bool large) {
        if (!candidate) {
            chain_->stay += weight;
            return;
        }
        if (large) chain_->large.add(chain_->state.candidate().target());
        candidate_ = weight + (large && large_count_ ? 1 : 0);
    }
    /// Deposits what wasn't accepted.
    void drop_candidate() {
        if (candidate_ > 0) store_(chain_->state.candidate(), candidate_);
        candidate_ = 0;
    }
    /// Deposits `state`, which is the chain's or was it until now.
    void leave(const Sample& state) {
        if (chain_->stay > 0) store_(state, chain_->stay);
        chain_->stay = 0;
    }

  private:
    PrimaryChain<State>* chain_;
    bool large_count_;
    Store store_;
    double candidate_ = 0; ///< weight that the candidate is to be deposited with
};

} // namespace keyhole
