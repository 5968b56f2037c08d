// A state-dependent choice between kinds of proposal.
//
// Kinds of one family are judged together: a candidate counts as made by all of them, weighted with how often each is
// chosen. A kind that rarely finds its own way back, such as a user path, can so return by the other's (Fan, Chenney,
// Lai 2005, section 5.1).
#pragma once

#include "sampling/proposal.h"

#include <memory>
#include <vector>

namespace keyhole {

/// Chooses kind k at state x with probability proportional to weight[k] * suitability_k(x). The probability is part of
/// the transition density in both directions. Immutable and thread-safe.
template <class State> class Mixture {
  public:
    /// Kinds of weight 0 are left out. Those of one family make the same moves: their densities are of the same new
    /// coordinates, or zero. kAlone: a family of its own.
    void add(std::unique_ptr<const Proposal<State>> kind, double weight, int family = kAlone) {
        if (weight > 0) kinds_.push_back({std::move(kind), weight, family});
    }
    static constexpr int kAlone = -1;

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

    /// Density of the move x -> y of kind k: its probability times its transition density, summed over its family.
    double density(const State& x, const State& y, std::size_t k) const {
        double sum = 0;
        for (std::size_t i = 0; i < kinds_.size(); ++i) {
            if (i != k && (kinds_[k].family == kAlone || kinds_[i].family != kinds_[k].family)) continue;
            const double w = kinds_[i].weight * kinds_[i].proposal->suitability(x);
            if (w > 0) sum += w * kinds_[i].proposal->transition_density(x, y);
        }
        return sum > 0 ? sum / total(x) : sum;
    }

    /// [f(y) / T(x->y)] / [f(x) / T(y->x)] of a candidate y of kind k: accepted with that probability, if below 1. Not
    /// a number, or infinite, where densities fail.
    double acceptance_ratio(const State& x, const State& y, std::size_t k) const {
        return (y.target / density(x, y, k)) / (x.target / density(y, x, k));
    }

  private:
    struct Kind {
        std::unique_ptr<const Proposal<State>> proposal;
        double weight;
        int family;
    };

    double total(const State& x) const {
        double sum = 0;
        for (const Kind& k : kinds_) sum += k.weight * k.proposal->suitability(x);
        return sum;
    }

    std::vector<Kind> kinds_;
};

} // namespace keyhole
