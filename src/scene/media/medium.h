// What fills the space between surfaces.
#pragma once

#include "scene/media/density_grid.h"

#include <cmath>
#include <memory>

namespace keyhole {

/// Absorbs and scatters. Where there is none there is vacuum.
struct Medium {
    Rgb absorption{0.0}, scattering{0.0};         ///< coefficients [1/m], 0 or more, where the density is 1
    float anisotropy = 0;                         ///< of the phase function; PhaseBsdf
    std::shared_ptr<const DensityGrid> density{}; ///< null: 1 everywhere

    bool scatters() const { return !is_black(scattering); }
    Rgb extinction() const { return absorption + scattering; }

    /// Share of light that is left after so much of it: `depth` is a length times density [m], and may be infinite
    /// (Beer's law).
    Rgb transmittance(double depth) const {
        const auto left = [depth](double s) { return s > 0 ? std::exp(-s * depth) : 1.0; };
        const Rgb s = extinction();
        return {left(s.x), left(s.y), left(s.z)};
    }
};

} // namespace keyhole
