// Points that cover the image window evenly, however many there are.
#pragma once

#include "core/kronecker.h"
#include "core/rng.h"
#include "core/vec.h"

#include <algorithm>
#include <cstdint>

namespace keyhole {

/// Window point of sample i: a rank-1 lattice (Roberts' R2), shifted by the seed.
inline Vec2 lattice_image_point(std::uint64_t seed, StreamPurpose purpose, std::int64_t i) {
    Rng shift(seed, purpose, ~0ULL);
    const auto k = static_cast<double>(i);
    const auto coordinate = [&](double alpha) {
        return std::min(static_cast<float>(kronecker(shift.next(), k, alpha)), 0x1.fffffep-1f);
    };
    const float x = coordinate(kR2[0]);
    return {x, coordinate(kR2[1])};
}

} // namespace keyhole
