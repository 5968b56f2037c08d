// Area lights.
#pragma once

#include "scene/emitter.h"
#include "scene/shape.h"

namespace keyhole {

/// Diffuse emission from the surface of `shape`, whose `emission` is set; points are uniform by area. Of an invisible
/// light no ray finds any. `shape` must outlive the emitter; `index` is its place in the scene.
/// @throws InputError for a shape without area.
std::unique_ptr<Emitter> make_area_emitter(const Shape& shape, std::uint32_t index);

} // namespace keyhole
