// A number that tells scenes apart, to guard what was computed from one of them.
#pragma once

#include "scene/scene.h"

#include <cstdint>

namespace keyhole {

/// Depends on every vertex and triangle, on the camera, and, through some thousands of light paths, on emitters,
/// materials, textures and media. The same scene has the same number on every run of the program on one kind of
/// machine.
std::uint64_t scene_hash(const Scene& scene);

} // namespace keyhole
