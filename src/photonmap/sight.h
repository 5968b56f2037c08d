// What a wall that stands on a surface hides from one another.
#pragma once

#include "photonmap/surface_region.h"
#include "scene/scene.h"

namespace keyhole {

/// Whether the middle of a region and `p`, a place of the same surface, see each other `lift` [m] above it. What is
/// lower than that doesn't part them.
inline bool in_sight(const Scene& scene, const SurfaceRegion& region, float lift, const Vec3& p) {
    SurfacePoint a, b;
    a.site = b.site = Site::point;
    a.p = region.position + region.normal * lift;
    b.p = p + region.normal * lift;
    return (b.p - a.p).length2() == 0 || scene.visible(a, b);
}

/// The share of the region of radius `r` that its middle sees, from 16 places spread over it evenly.
inline double share_in_sight(const Scene& scene, const SurfaceRegion& region, float r, float lift) {
    const Frame frame(region.normal);
    constexpr int kPlaces = 16;
    int seen = 0;
    for (int i = 0; i < kPlaces; ++i) {
        const double distance = r * std::sqrt((i + 0.5) / kPlaces), angle = 2.399963229728653 * i; // sunflower
        const Vec3 offset = frame.s * static_cast<float>(distance * std::cos(angle)) +
                            frame.t * static_cast<float>(distance * std::sin(angle));
        seen += in_sight(scene, region, lift, region.position + offset) ? 1 : 0;
    }
    return static_cast<double>(seen) / kPlaces;
}

} // namespace keyhole
