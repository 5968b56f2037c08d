// The one rule that accepts or rejects, for chains over paths and in primary sample space. Knows no rendering.
#pragma once

#include <algorithm>
#include <cmath>

namespace keyhole {

/// min(1, ratio), the Metropolis-Hastings rule (Hastings 1970) for ratio = [f(y) / T(x->y)] / [f(x) / T(y->x)]. 0 where
/// that is zero or not a finite number.
inline double acceptance(double ratio) { return ratio > 0 && std::isfinite(ratio) ? std::min(ratio, 1.0) : 0.0; }

/// Whether a candidate of acceptance probability `a` becomes the state.
template <class Stream> bool accepts(double a, Stream& rng) { return a > 0 && rng.next() < a; }

/// The same after deposits of expected values, which use what is rejected, too (Veach 1997, chapter 11):
/// deposit(false, 1 - a) for the state, then deposit(true, a) for the candidate, each only where its weight is
/// positive.
template <class Stream, class Deposit> bool deposit_and_accept(double a, Stream& rng, Deposit&& deposit) {
    if (a < 1) deposit(false, 1 - a);
    if (a > 0) deposit(true, a);
    return accepts(a, rng);
}

} // namespace keyhole
