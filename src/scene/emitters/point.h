// A light without extent.
#pragma once

#include "scene/emitter.h"

#include <memory>

namespace keyhole {

/// Light from one point, the same in all directions.
/// @param position world space.
/// @param intensity radiant intensity in W/sr; its power is 4 pi times that.
std::unique_ptr<Emitter> make_point_emitter(const Vec3& position, const Rgb& intensity);

} // namespace keyhole
