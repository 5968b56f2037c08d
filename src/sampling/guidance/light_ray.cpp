#include "sampling/guidance/light_ray.h"

#include "sampling/paths/walk.h"

namespace keyhole {

std::vector<Vertex> follow_light(const Scene& scene, const SurfacePoint& from, Vec3 w, std::size_t most,
                                 AtGlass at_glass) {
    std::vector<Vertex> found;
    SurfacePoint origin = from;
    while (found.size() < most) {
        const auto hit = next_vertex(scene, origin, w);
        if (!hit || hit->point.site != Site::surface) break;
        found.push_back(*hit);
        Vertex& v = found.back();
        if (v.bsdf.traits().finite) break;
        // Total reflection leaves no choice, and a mirror neither.
        const auto reflected = v.bsdf.delta(-w, Event::reflect), transmitted = v.bsdf.delta(-w, Event::transmit);
        if (!reflected && !transmitted) break;
        const bool through = transmitted && (!reflected || at_glass == AtGlass::transmit);
        v.event = through ? Event::transmit : Event::reflect;
        w = through ? transmitted->to : reflected->to;
        origin = v.point;
    }
    return found;
}

} // namespace keyhole
