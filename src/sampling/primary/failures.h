// What a chain does with proposals that make no complete path.
#pragma once

#include <cstdint>

namespace keyhole {

/// Treatment of failed proposals, those of target 0.
enum class Failures {
    exclude, ///< left out of the chain, as published (Zeng and Wei 2019). The stationary density becomes target times
             ///< the probability that a proposal succeeds: biased where that depends on the state
    reject,  ///< the chain stays where it is: plain Metropolis-Hastings
    exclude_large, ///< only large steps are left out. They succeed with the same probability from every state: exact
    delay,         ///< a second try before the chain stays: delayed rejection (Tierney and Mira 1999). Exact
};

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
    StepCounts small, large, second; ///< first tries by size; second tries
    std::uint64_t left_out = 0;      ///< failed proposals that the chain does not count as steps

    PrimaryCounts& operator+=(const PrimaryCounts& o) {
        small += o.small;
        large += o.large;
        second += o.second;
        left_out += o.left_out;
        return *this;
    }
    std::uint64_t proposals() const { return small.proposed + large.proposed; }
    /// Steps that count towards the mean.
    std::uint64_t steps() const { return proposals() - left_out; }
    /// Failed first tries whose second try made a path.
    std::uint64_t remedied() const { return second.proposed - second.failed; }
};

} // namespace keyhole
