// Following light by hand, to find points for a user path.
#pragma once

#include "sampling/paths/path.h"
#include "scene/scene.h"

#include <vector>

namespace keyhole {

/// Which way to take where a surface both reflects and transmits.
enum class AtGlass { transmit, reflect };

/// The vertices that a ray from `from` along `w` (unit) meets: through specular ones, to the first that scatters
/// finitely or that lets no light on, at most `most`. Their events are those that were followed; `from` isn't among
/// them.
std::vector<Vertex> follow_light(const Scene& scene, const SurfacePoint& from, Vec3 w, std::size_t most,
                                 AtGlass at_glass = AtGlass::transmit);

} // namespace keyhole
