// A state-dependent choice between kinds of proposal.
#pragma once

#include "sampling/proposal.h"

#include <memory>
#include <vector>

namespace keyhole {

/// Chooses kind k at state x with probability proportional to weight[k] * suitability_k(x). The probability is part of
/// the transition density in both directions. Immutable and thread-safe.
template <class State> class Mixture {
  public:
    /// Kinds of weight 0 are left out.
    void add(std::unique_ptr<const Proposal<State>> kind, double weight) {
        if (weight > 0) kinds_.push_back({std::move(kind), weight});
    }

    std::size_t size() const { return kinds_.size(); }
    const Proposal<State>& kind(std::size_t k) const { return *kinds_[k].proposal; }

    /// Index of a kind that suits x; none if no kind does.
    std::optional<std::size_t> choose(const State& x, Rng& rng) const {
        double left = rng.next() * total(x);
        std::optional<std::size_t> last;
        for (std::size_t k = 0; k < kinds_.size(); ++k) {
            const double w = kinds_[k].weight * kinds_[k].proposal->suitability(x);
            if (w <= 0) continue;
            last = k;
            if ((left -= w) < 0) break;
        }
        return last;
    }

    /// Probability that choose(x) gives k.
    double probability(const State& x, std::size_t k) const {
        const double w = kinds_[k].weight * kinds_[k].proposal->suitability(x);
        return w > 0 ? w / total(x) : 0.0;
    }

  private:
    struct Kind {
        std::unique_ptr<const Proposal<State>> proposal;
        double weight;
    };

    double total(const State& x) const {
        double sum = 0;
        for (const Kind& k : kinds_) sum += k.weight * k.proposal->suitability(x);
        return sum;
    }

    std::vector<Kind> kinds_;
};

} // namespace keyhole
