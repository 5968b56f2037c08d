// Points whose shading normals are turned.
#pragma once

#include "scene/surface_point.h"

namespace keyhole {

/// `point` with the shading normal `ns`, unit; as it is where that lies below the surface.
inline SurfacePoint turned(const SurfacePoint& point, const Vec3& ns) {
    if (!(ns.dot(point.ng) > 0)) return point;
    const Frame frame = point.shading_frame();
    SurfacePoint out = point;
    out.ns = ns;
    out.tangent = (frame.s - ns * ns.dot(frame.s)).normalized();
    return out;
}

} // namespace keyhole
