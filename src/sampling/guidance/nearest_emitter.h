// Which light somebody meant who gave a place near it.
#pragma once

#include "scene/scene.h"

#include <optional>

namespace keyhole {

struct NearestEmitter {
    SurfacePoint point; ///< with its emitter
    double distance;    ///< of the given place from it; 0 inside an emitting sphere [m]
};

/// The point of the scene's emitters nearest to `p`, world space; none if all emitters are infinite. For a place deep
/// inside an emitting sphere, which has no nearest point worth the name, the point that faces `towards`.
std::optional<NearestEmitter> nearest_emitter_point(const Scene& scene, const Imath::V3d& p, const Imath::V3d& towards);

} // namespace keyhole
