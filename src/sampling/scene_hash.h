// A number that tells scenes apart, to guard what was computed from one of them.
#pragma once

#include "scene/scene.h"

#include <cstdint>

namespace keyhole {

/// Depends on every vertex, triangle and texture coordinate, on the camera, on every pixel of images of textures, on
/// media, and on what every material, opacity and emitter says at points of the shapes that have it (hundreds; 4 where
/// there are thousands of them). What that doesn't show is unseen: a change of a procedural texture between those
/// points, or of a few pixels of an environment's picture that leaves its power the same to seven digits. Names don't
/// count, nor does the size of the picture. The same on every run, and on all machines whose libraries agree on floats.
/// Takes a few milliseconds and a pass over the geometry. Images that other scenes hold at the time count as well.
std::uint64_t scene_hash(const Scene& scene);

} // namespace keyhole
