// Steps of chains whose proposals are symmetric and may fail, what became of them, and how many are to be large. Knows
// no rendering.
#pragma once

#include "core/choices.h"
#include "core/rng.h"
#include "sampling/markov/acceptance.h"
#include "sampling/primary/primary_vector.h"

#include <algorithm>
#include <cstdint>

namespace keyhole {

/// What became of the steps of one size.
struct StepCounts {
    std::uint64_t proposed = 0, failed = 0, accepted = 0;
    double acceptance = 0; ///< sum of acceptance probabilities

    StepCounts& operator+=(const StepCounts& o) {
        proposed += o.proposed;
        failed += o.failed;
        accepted += o.accepted;
        acceptance += o.acceptance;
        return *this;
    }
    double share(double n) const { return proposed > 0 ? n / static_cast<double>(proposed) : 0.0; }
    double mean_acceptance() const { return share(acceptance); }
    double failure_rate() const { return share(static_cast<double>(failed)); }
};

/// The ledger of a chain in primary sample space.
struct PrimaryCounts {
    StepCounts small, large, delayed; ///< first proposals by size; those of delayed rejection
    std::uint64_t left_out = 0;       ///< failed proposals that the chain does not count as steps

    PrimaryCounts& operator+=(const PrimaryCounts& o) {
        small += o.small;
        large += o.large;
        delayed += o.delayed;
        left_out += o.left_out;
        return *this;
    }
    std::uint64_t proposals() const { return small.proposed + large.proposed; }
    /// Steps that count towards the mean.
    std::uint64_t steps() const { return proposals() - left_out; }
    /// Failed proposals after which a delayed one made a path.
    std::uint64_t remedied() const { return delayed.proposed - delayed.failed; }
};

/// A Metropolis chain whose proposals are symmetric, over a `Space` with
///     double propose(Step);   // makes a candidate and returns its target; 0: it failed
///     double target() const;  // of the state; positive
///     void accept();          // the candidate becomes the state
/// where Step::delayed, after a failed candidate y, makes z with q1(x->y) q2(x,y->z) = q1(z->y) q2(z,y->x): both
/// densities then leave the acceptance of a delayed rejection (Tierney and Mira 1999, eq. 3), and min(1, f(z) / f(x))
/// stays.
struct PrimaryKernel {
    Failures failures = Failures::reject;
    double p_large = 0.5;

    /// One proposal. Tells deposit(candidate, weight, large) about what it brings: `candidate` false for the state as
    /// it was, with weight 1 - a, true for the candidate with weight a; `large`: the candidate is a large step, a
    /// sample on its own account. False, and nothing told, if the proposal is left out and no step of the chain.
    template <class Space, class Deposit>
    bool step(Space& space, Rng& rng, PrimaryCounts& counts, Deposit&& deposit) const {
        const bool large = rng.next() < p_large;
        StepCounts& first = large ? counts.large : counts.small;
        ++first.proposed;
        const double y = space.propose(large ? Step::large : Step::small);
        if (y > 0) {
            decide(space, y, large, rng, first, deposit);
            return true;
        }
        ++first.failed;
        if (failures == Failures::exclude || (failures == Failures::exclude_large && large)) {
            ++counts.left_out;
            return false;
        }
        if (failures == Failures::delay) {
            ++counts.delayed.proposed;
            const double z = space.propose(Step::delayed);
            if (z > 0) {
                decide(space, z, false, rng, counts.delayed, deposit);
                return true;
            }
            ++counts.delayed.failed;
        }
        deposit(false, 1.0, false);
        return true;
    }

  private:
    template <class Space, class Deposit>
    static void decide(Space& space, double target, bool large, Rng& rng, StepCounts& counts, Deposit&& deposit) {
        const double a = acceptance(target / space.target());
        counts.acceptance += a;
        if (!deposit_and_accept(a, rng, [&](bool candidate, double w) { deposit(candidate, w, candidate && large); }))
            return;
        ++counts.accepted;
        space.accept();
    }
};

/// What the rule learns from, and what it says.
struct LargeStepRule {
    double eta_s;    ///< acceptance of small steps
    double eta_l;    ///< acceptance of large steps
    double eta_0;    ///< share of large steps that make a path with light
    bool by_formula; ///< false: the second branch
    double p_large;
};

/// The rule of Zsolnai and Szirmay-Kalos ("Automatic Parameter Control for Metropolis Light Transport", 2013):
/// eta_s / (2 (eta_s - eta_l)), at most 1, where large steps that carry light are accepted often enough, eta_l / eta_0
/// > 0.1; else 1/4. Where large steps are accepted no less than small ones, which the formula does not predict, 1.
inline LargeStepRule large_step_rule(const PrimaryCounts& counts) {
    LargeStepRule rule{counts.small.mean_acceptance(), counts.large.mean_acceptance(), 1 - counts.large.failure_rate(),
                       false, 0.25};
    rule.by_formula = rule.eta_l > 0.1 * rule.eta_0;
    if (!rule.by_formula) return rule;
    const double gain = rule.eta_s - rule.eta_l;
    rule.p_large = gain > 0 ? std::min(1.0, rule.eta_s / (2 * gain)) : 1.0;
    return rule;
}

/// Steps of each chain in two batches. The first 32nd part learns how often large steps are accepted and fail, with
/// half of the steps large, and deposits nothing.
struct LearningBatch {
    std::int64_t steps, rest;

    explicit LearningBatch(std::int64_t all)
        : steps(std::max<std::int64_t>(1, all / 32)), rest(std::max<std::int64_t>(1, all - steps)) {}
};

} // namespace keyhole
