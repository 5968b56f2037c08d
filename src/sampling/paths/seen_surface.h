// What a pixel tells of the first surface seen that is not specular: the same by every method.
#pragma once

#include "core/pixel_sample.h"
#include "sampling/paths/path.h"

#include <algorithm>

namespace keyhole {

/// Notes in `pixel` that the eye sees `v` from `back` (unit, towards the eye), as the first vertex of its walk with a
/// finite BSDF; `throughput` is the RGB importance that arrives there (window density 1). `share`: where a walk was
/// split, the probability with which one that is not would have come here; the normals of its parts add up.
inline void note_seen_surface(PixelSample& pixel, const Vertex& v, const Vec3& back, const Rgb& throughput,
                              double share = 1) {
    pixel.albedo += throughput * v.bsdf.albedo(back);
    pixel.normal += facing(v.point.ng, back) * static_cast<float>(share);
}

/// The distance from where the view begins to the first surface [m]; `eye` is the vertex that it is seen from.
inline double seen_depth(const SurfacePoint& eye, const SurfacePoint& seen) {
    return std::max(0.0f, (seen.p - eye.p).length() - (eye.site == Site::point ? eye.offset : 0.0f));
}

} // namespace keyhole
