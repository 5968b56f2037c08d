// What one sample of a pixel tells.
#pragma once

#include "core/vec.h"

namespace keyhole {

/// Radiance [W/(m^2 sr)] by the way it took, and what the first non-specular surface looks like.
struct PixelSample {
    Rgb direct{0.0};   ///< emission seen, and light that arrived straight from an emitter
    Rgb indirect{0.0}; ///< light with two or more non-specular scatterings
    Rgb caustic{0.0};  ///< light that came through specular surfaces to the surface seen
    Rgb albedo{0.0};   ///< hemispherical reflectance of the first non-specular surface, approximately, times throughput
    Vec3 normal{0, 0, 0}; ///< its geometric one on the side that is seen
    double depth = 0;     ///< distance along the ray to the first surface of any kind [m]; 0: nothing
};

} // namespace keyhole
