// Where the eye meets surfaces that an irradiance cache may know.
#pragma once

#include "gather/gather_rays.h"

#include <optional>

namespace keyhole {

struct VisiblePoint {
    Vertex vertex;
    Vec3 back;       ///< unit
    double pixel;    ///< width of a pixel there [m]
    int scatterings; ///< from the eye, this one included

    /// Whether a ray along `w` starts outwards: a shading normal may look into the surface.
    bool leaves(const Vec3& w) const { return w.dot(facing(vertex.point.ng, back)) > 0; }
};

/// The point with a diffuse part that is seen at `image` (window coordinates), by events chosen at random: where it has
/// a smooth coat, the mirror image in that may be looked at instead.
std::optional<VisiblePoint> visible_point(const GatherRays& rays, const Vec2& image, SampleSource& source);

/// A gather ray of the point that is seen at `image`, as records send them.
struct FirstGatherRay {
    VisiblePoint from;
    Vec3 w;     ///< unit
    double pdf; ///< per solid angle: of the cosine about cache_normal()
};
/// None where nothing with a diffuse part is seen, or the ray would start into the surface.
std::optional<FirstGatherRay> first_gather_ray(const GatherRays& rays, const Vec2& image, SampleSource& source);

/// Shading normal on the side of `back`: what irradiance records are kept by.
Vec3 cache_normal(const Vertex& v, const Vec3& back);

} // namespace keyhole
