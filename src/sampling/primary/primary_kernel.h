// The one place that accepts or rejects in primary sample space. Knows no rendering.
#pragma once

#include "core/rng.h"
#include "sampling/primary/failures.h"
#include "sampling/primary/primary_vector.h"

namespace keyhole {

/// A Metropolis chain whose proposals are symmetric, over a `Space` with
///     double propose(Step);   // makes a candidate and returns its target; 0: it failed
///     double target() const;  // of the state; positive
///     void accept();          // the candidate becomes the state
/// where Step::second, after a failed candidate y, makes z with q1(x->y) q2(x,y->z) = q1(z->y) q2(z,y->x): both
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
            ++counts.second.proposed;
            const double z = space.propose(Step::second);
            if (z > 0) {
                decide(space, z, false, rng, counts.second, deposit);
                return true;
            }
            ++counts.second.failed;
        }
        deposit(false, 1.0, false);
        return true;
    }

  private:
    template <class Space, class Deposit>
    static void decide(Space& space, double target, bool large, Rng& rng, StepCounts& counts, Deposit&& deposit) {
        const double ratio = target / space.target();
        const double a = ratio >= 1 ? 1.0 : ratio > 0 ? ratio : 0.0;
        counts.acceptance += a;
        if (a < 1) deposit(false, 1 - a, false);
        deposit(true, a, large);
        if (rng.next() >= a) return;
        ++counts.accepted;
        space.accept();
    }
};

} // namespace keyhole
