// A point light with a shade.
#pragma once

#include "scene/emitter.h"

namespace keyhole {

/// Light from one point into a cone, fading towards its edge: between the angles `full` and `edge` from the axis the
/// intensity falls by smoothstep(cos) from 1 to 0, as pbrt's spot light does.
struct SpotParameters {
    Vec3 position{0, 0, 0};   ///< world space
    Vec3 axis{0, 0, -1};      ///< unit; the middle of the cone
    Rgb intensity{1.0};       ///< radiant intensity on the axis, W/sr
    double full_degrees = 25; ///< full intensity up to here; at most `edge_degrees`
    double edge_degrees = 30; ///< dark from here on; above 0, at most 180
};

/// Power over intensity on the axis [sr].
double spot_solid_angle(const SpotParameters& parameters);

/// Directions are drawn in proportion to the intensity.
/// @throws InputError for angles out of order.
std::unique_ptr<Emitter> make_spot_emitter(const SpotParameters& parameters);

} // namespace keyhole
