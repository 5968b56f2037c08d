// Lights of pbrt's format.
#pragma once

#include "scene/emitter.h"
#include "scene/load/geometry_transform.h"
#include "scene/pbrt/parameters.h"

#include <memory>

namespace keyhole::pbrt {

/// What an `AreaLightSource` makes of the shapes that follow it.
struct AreaLight {
    Rgb radiance{0.0}; ///< W/(m^2 sr); a colour of luminance 1 times a scale where power is given
    bool two_sided = false;
    double power = 0; ///< W, of each triangle, patch or quadric; 0: radiance says it all
};

/// A light, and whether it is one of those that rays meet where they miss everything.
struct LightSource {
    std::unique_ptr<Emitter> emitter; ///< null for a black light
    bool environment = false;
};

/// Reads an `AreaLightSource` directive. @throws InputError for kinds other than diffuse, and for pictures.
AreaLight read_area_light(Parameters& parameters, double exposure);

/// Reads a `LightSource` directive: `point`, `spot`, `distant` or `infinite`.
/// @throws InputError for other kinds, and for pictures that can't be read.
LightSource read_light(Parameters& parameters, const Transform& to_world, double exposure);

} // namespace keyhole::pbrt
