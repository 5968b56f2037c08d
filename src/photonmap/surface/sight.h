// What a wall that stands on a surface hides from one another.
#pragma once

#include "photonmap/surface/surface_region.h"
#include "sampling/paths/gather_coverage.h"
#include "scene/scene.h"

#include <algorithm>

namespace keyhole {

/// Whether the middle of a region and `p`, a place of the same surface, see each other `lift` [m] above it. What is
/// lower than that doesn't part them.
inline bool in_sight(const Scene& scene, const SurfaceRegion& region, float lift, const Vec3& p) {
    // Far from the origin positions are no more accurate than that.
    const Vec3 above = region.normal * std::max(lift, 2 * scene.rounding_along(region.normal, region.position));
    return p == region.position || scene.visible(region.position + above, p + above);
}

/// The height at which the middle of a region of radius `r` looks at its photons: above all that counts as its surface.
inline float sight_lift(float r) { return 2 * r / SurfaceRegion::kFlattening; }

/// The share of the region of radius `r` of which `holds(place)` says that something holds there, among those of 16
/// places spread over it evenly of which `counts(place)`; 0 if there are none.
template <class Counts, class Holds>
double share_of_region(const SurfaceRegion& region, float r, const Counts& counts, const Holds& holds) {
    const Frame frame(region.normal);
    constexpr int kPlaces = 16;
    int counted = 0, held = 0;
    for (int i = 0; i < kPlaces; ++i) {
        const double distance = r * std::sqrt((i + 0.5) / kPlaces), angle = kGoldenAngle * i;
        const Vec3 offset = frame.s * static_cast<float>(distance * std::cos(angle)) +
                            frame.t * static_cast<float>(distance * std::sin(angle));
        const Vec3 place = region.position + offset;
        if (!counts(place)) continue;
        ++counted;
        held += holds(place) ? 1 : 0;
    }
    return counted > 0 ? static_cast<double>(held) / counted : 0.0;
}

/// The share that gather rays come to: outside their coverage the global map is empty. At least that of the middle,
/// where something was found; 1 if they come everywhere.
inline double share_in_reach(const GatherCoverage* coverage, const SurfaceRegion& region, float r) {
    if (coverage == nullptr) return 1;
    const auto anywhere = [](const Vec3&) { return true; };
    const auto reached = [&](const Vec3& p) { return coverage->comes_to(p, region.normal); };
    return std::max(1.0 / 16, share_of_region(region, r, anywhere, reached));
}

} // namespace keyhole
