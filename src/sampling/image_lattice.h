// Points that cover the image window evenly, however many there are.
#pragma once

#include "core/rng.h"
#include "core/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace keyhole {

/// Window point of sample i: a rank-1 lattice (Roberts' R2), shifted by the seed.
inline Vec2 lattice_image_point(std::uint64_t seed, StreamPurpose purpose, std::int64_t i) {
    Rng shift(seed, purpose, ~0ULL);
    const auto k = static_cast<double>(i);
    const double x = shift.next() + k * 0.7548776662466927, y = shift.next() + k * 0.5698402909980532;
    return {std::min(static_cast<float>(x - std::floor(x)), 0x1.fffffep-1f),
            std::min(static_cast<float>(y - std::floor(y)), 0x1.fffffep-1f)};
}

} // namespace keyhole
