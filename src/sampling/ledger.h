// What became of each proposal.
#pragma once

#include "sampling/proposal.h"

#include <cstdint>
#include <vector>

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

} // namespace keyhole
