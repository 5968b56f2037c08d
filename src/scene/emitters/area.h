// Area lights.
#pragma once

#include "scene/emitter.h"
#include "scene/shape.h"

namespace keyhole {

/// Diffuse emission from the surface of `shape`, whose `emission` is set; points are uniform by area. Of an invisible
/// light no ray finds any. `shape` must outlive the emitter; `index` is its place in the scene.
/// @throws InputError for a shape without area.
std::unique_ptr<Emitter> make_area_emitter(const Shape& shape, std::uint32_t index);

/// Whether an emitter is an invisible light: one with a surface that no ray can hit. Its light is seen on what scatters
/// it; the eye looks through the lamp itself, in whatever way its paths are made.
inline bool is_invisible(const Emitter& emitter) { return emitter.is_delta() && emitter.site() == Site::surface; }

} // namespace keyhole
