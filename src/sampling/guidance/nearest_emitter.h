// Finding points for a user path: which light somebody meant who gave a place near it, and where its light goes.
#pragma once

#include "sampling/paths/path.h"
#include "scene/scene.h"

#include <optional>
#include <vector>

namespace keyhole {

struct NearestEmitter {
    SurfacePoint point; ///< with its emitter
    double distance;    ///< of the given place from it; 0 inside an emitting sphere [m]
};

/// The point of the scene's emitters nearest to `p`, world space; none if all emitters are infinite. Of points within
/// `reach` one that sends light `towards` goes before nearer ones that don't: who means a lamp points at its middle, to
/// which its back may be nearer. For a place deep inside an emitting sphere, which has no nearest point worth the name,
/// the point that faces `towards`.
std::optional<NearestEmitter> nearest_emitter_point(const Scene& scene, const Imath::V3d& p, const Imath::V3d& towards,
                                                    double reach = 0);

/// Which way to take where a surface both reflects and transmits.
enum class AtGlass { transmit, reflect };

/// The vertices that a ray from `from` along `w` (unit) meets: through specular ones, to the first that scatters
/// finitely or that lets no light on, at most `most`. Their events are those that were followed; `from` isn't among
/// them.
std::vector<Vertex> follow_light(const Scene& scene, const SurfacePoint& from, Vec3 w, std::size_t most,
                                 AtGlass at_glass = AtGlass::transmit);

} // namespace keyhole
