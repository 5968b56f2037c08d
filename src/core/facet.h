// Directions sorted by the axis that they are nearest to.
#pragma once

#include "core/vec.h"

#include <cmath>
#include <cstddef>

namespace keyhole {

/// The direction of the six along the axes that is nearest to `n`, of any length: x, y, z, -x, -y, -z.
inline std::size_t facet_of(const Vec3& n) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(n[i]) > std::abs(n[axis])) axis = i;
    return static_cast<std::size_t>(n[axis] < 0 ? axis + 3 : axis);
}

} // namespace keyhole
