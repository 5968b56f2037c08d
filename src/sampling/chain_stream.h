// Random numbers of one chain among many.
#pragma once

#include "core/rng.h"

#include <cmath>

namespace keyhole {

/// The stream of chain `index`. The k-th points of all chains are one rank-1 lattice (Roberts' R2), shifted at random
/// for each k: together they cover the image evenly, so that every part of it has its turn.
///
/// Stratified among chains and not along one: what a chain draws next must not depend on what it drew before, of which
/// its state still knows. Each chain alone sees independent uniform points, as an exact transition needs.
class ChainStream final : public Rng {
  public:
    ChainStream(std::uint64_t seed, std::uint64_t index)
        : Rng(seed, StreamPurpose::chain, 2 * index), seed_(seed), index_(static_cast<double>(index)) {}

    std::array<double, 2> next_point() override {
        Rng shift(seed_, StreamPurpose::chain_points, round_++);
        const double x = shift.next() + index_ * 0.7548776662466927, y = shift.next() + index_ * 0.5698402909980532;
        return {x - std::floor(x), y - std::floor(y)};
    }

  private:
    std::uint64_t seed_, round_ = 0;
    double index_;
};

} // namespace keyhole
