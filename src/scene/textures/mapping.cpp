#include "scene/textures/mapping.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

Imath::V2d TextureMapping::operator()(const SurfacePoint& point) const {
    if (projection == Projection::uv) return uv(Imath::V2d(point.uv));
    const Imath::V3d p = Imath::V3d(point.p) * from_world;
    if (projection == Projection::planar) return uv({p.x, p.y});
    const double longitude = std::atan2(p.y, p.x); // from -pi to pi
    if (projection == Projection::cylindrical) return uv({(longitude + kPi) / (2 * kPi), p.z});
    const double r = p.length();
    return uv({(longitude < 0 ? longitude + 2 * kPi : longitude) / (2 * kPi),
               r > 0 ? std::acos(std::clamp(p.z / r, -1.0, 1.0)) / kPi : 0.0});
}

} // namespace keyhole
