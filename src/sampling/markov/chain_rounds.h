// Steps of chains in rounds.
#pragma once

#include "core/parallel.h"
#include "core/progress.h"

#include <algorithm>
#include <cstdint>

namespace keyhole {

/// How the steps of equally long chains are parted, so that a stop finds all chains equally long and what they have
/// found is merged in a fixed order between rounds: in rounds of one length, the last one shorter, or in so many even
/// ones.
class ChainRounds {
  public:
    static ChainRounds of_length(std::int64_t steps, std::int64_t length) { return {steps, length, 0}; }
    static ChainRounds even(std::int64_t steps, std::int64_t count) { return {steps, 0, count}; }

    /// Calls advance(n) for each round of n steps until all are done, or after a stop; the first one always. Tells
    /// nothing of its progress: chains do. @returns the steps that were done, by each chain
    template <class Advance> std::int64_t run(const RunContext& context, Advance&& advance) const {
        std::int64_t done = 0;
        for (std::int64_t i = 0; done < steps_ && !(context.stopped() && done > 0); ++i) {
            const std::int64_t n = length_ > 0 ? std::min(length_, steps_ - done) : split(steps_, count_, i).size();
            advance(n);
            done += n;
        }
        return done;
    }

  private:
    ChainRounds(std::int64_t steps, std::int64_t length, std::int64_t count)
        : steps_(steps), length_(length), count_(count) {}

    std::int64_t steps_, length_, count_;
};

} // namespace keyhole
