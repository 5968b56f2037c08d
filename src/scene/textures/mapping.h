// Where in a texture a point of a surface lies.
#pragma once

#include "core/vec.h"
#include "scene/surface_point.h"

#include <Imath/ImathMatrix.h>

namespace keyhole {

/// Scales texture coordinates, then turns them about the origin, then shifts them.
struct UvMapping {
    double su = 1, sv = 1, du = 0, dv = 0;
    double cosine = 1, sine = 0; ///< of the turn, anticlockwise where u is right and v is up

    Imath::V2d operator()(const Imath::V2d& uv) const {
        const double u = su * uv.x, v = sv * uv.y;
        return {cosine * u - sine * v + du, sine * u + cosine * v + dv};
    }
};

/// What texture coordinates are taken from, with (x, y, z) the place in the space of the texture.
enum class Projection {
    uv,          ///< the parametrisation of the shape
    planar,      ///< (x, y)
    spherical,   ///< longitude about z from +x over 2 pi, and angle from +z over pi, as on spheres
    cylindrical, ///< longitude about z from -x over 2 pi, and z
};

struct TextureMapping {
    UvMapping uv{};
    Projection projection = Projection::uv;
    Imath::M44d from_world{}; ///< to the space of the texture, for row vectors

    Imath::V2d operator()(const SurfacePoint& point) const;
};

} // namespace keyhole
