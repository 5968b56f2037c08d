// What fills the space between surfaces.
#pragma once

#include "core/vec.h"

#include <cmath>

namespace keyhole {

/// Absorbs, and scatters nothing. Where there is none there is vacuum.
struct Medium {
    Rgb absorption{0.0}; ///< coefficient [1/m], 0 or more

    /// Share of light that is left after `length` [m] (Beer's law); `length` may be infinite.
    Rgb transmittance(double length) const {
        const auto left = [length](double a) { return a > 0 ? std::exp(-a * length) : 1.0; };
        return {left(absorption.x), left(absorption.y), left(absorption.z)};
    }
};

} // namespace keyhole
