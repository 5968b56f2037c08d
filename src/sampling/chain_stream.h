// Random numbers of one chain among many.
#pragma once

#include "core/kronecker.h"
#include "core/rng.h"

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
        const double x = kronecker(shift.next(), index_, kR2[0]);
        return {x, kronecker(shift.next(), index_, kR2[1])};
    }

  private:
    std::uint64_t seed_, round_ = 0;
    double index_;
};

} // namespace keyhole
