// Which places count as the same piece of surface in a density estimate. Photons and areas are both measured with this,
// so that what is counted and what it is divided by can't differ.
#pragma once

#include "core/vec.h"

namespace keyhole {

/// Places (r sqrt((i + 1/2) / n), i times this angle), i < n, are spread evenly over a disc (Vogel 1979).
constexpr double kGoldenAngle = 2.399963229728653;

/// A place on a surface, and the region around it: an ellipsoid of radius r in the tangent plane and r / kFlattening
/// along the normal, in which only normals within about 26 degrees of its own count. Photons of another wall, of the
/// other side of a sheet or of the next step of a stair lie outside.
struct SurfaceRegion {
    static constexpr float kFlattening = 8;
    static constexpr float kMinCosine = 0.9f;

    Vec3 position; ///< world space
    Vec3 normal;   ///< unit, geometric, on the side that is looked at

    /// Squared radius of the region that has `p` on its border [m^2]. Never below the squared Euclidean distance.
    float distance2(const Vec3& p) const {
        const Vec3 d = p - position;
        const float height = d.dot(normal);
        return d.length2() + height_term(height);
    }
    /// What a height above or below the surface adds to the squared distance [m^2].
    static float height_term(float height) { return (kFlattening * kFlattening - 1) * height * height; }

    /// Whether a normal of any length is close to that of the region.
    bool accepts(const Vec3& n) const {
        const float cosine = n.dot(normal);
        return cosine > 0 && cosine * cosine > kMinCosine * kMinCosine * n.length2();
    }
};

} // namespace keyhole
