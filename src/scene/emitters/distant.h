// The sun, but without its disc.
#pragma once

#include "scene/emitter.h"

namespace keyhole {

/// Light from one direction, everywhere alike.
/// @param w unit direction in which it travels, world space.
/// @param irradiance in W/m^2 on a plane across `w`. Its power is that times the cross-section of the scene's sphere.
std::unique_ptr<Emitter> make_distant_emitter(const Vec3& w, const Rgb& irradiance);

} // namespace keyhole
