#include "sampling/paths/clear_glass.h"

#include "sampling/paths/walk.h"

namespace keyhole {
namespace {

/// A view on its way through clear glass.
struct View {
    SurfacePoint from;
    Vec3 w;
    Rgb transmittance{1.0};
    StraightLight light{};

    /// Goes on through `v`, which it has come to. False where that isn't clear glass, or lets nothing through.
    bool pass(const Scene& scene, Vertex& v) {
        if (clear_glass(v) == ClearGlass::none) return false;
        const auto lobe = v.bsdf.delta(-w, Event::transmit);
        if (!lobe) return false;
        transmittance *= scene.transmittance(from, v.point) * lobe->coefficient / (lobe->eta * lobe->eta);
        v.event = Event::transmit;
        light.meet(v, w);
        from = v.point;
        w = lobe->to;
        return true;
    }
};

} // namespace

Rgb straight_transmittance(const Scene& scene, const SurfacePoint& from, const SurfacePoint& x0, int most_faces,
                           const std::function<void(const Vertex&)>& passed) {
    const bool infinite = x0.site == Site::infinite;
    View view{from, direction(from, x0)};
    for (int faces = 0;; ++faces) {
        const SurfacePoint end = infinite ? infinite_point(view.w) : x0;
        if (scene.visible(view.from, end))
            return view.light.straight(view.w, infinite) ? view.transmittance * scene.transmittance(view.from, end)
                                                         : Rgb(0.0);
        if (faces == most_faces || !scene.meets_clear_glass(view.from, view.w)) break;
        auto hit = next_vertex(scene, view.from, view.w);
        if (!hit || hit->point.site == Site::infinite || !view.pass(scene, *hit)) break;
        if (!infinite && !view.light.straight(view.w, false)) break;
        if (passed) passed(*hit);
    }
    return Rgb(0.0);
}

std::optional<StraightView> look_straight(const Scene& scene, const SurfacePoint& from, const Vec3& w, int most_faces) {
    View view{from, w};
    for (int faces = 0; faces <= most_faces; ++faces) {
        auto hit = next_vertex(scene, view.from, view.w);
        if (!hit) return std::nullopt;
        if (view.pass(scene, *hit)) continue;
        if (!view.light.straight(view.w, hit->point.site == Site::infinite)) return std::nullopt;
        return StraightView{*hit, view.transmittance * scene.transmittance(view.from, hit->point)};
    }
    return std::nullopt;
}

} // namespace keyhole
