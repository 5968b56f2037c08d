#include "sampling/guidance/nearest_emitter.h"

#include "sampling/paths/walk.h"
#include "scene/geometry.h"

#include <algorithm>
#include <limits>

namespace keyhole {
namespace {

using V3 = Imath::V3d;

/// Barycentric coordinates of the point of a triangle nearest to p: inside, or on the nearest of its three edges.
Vec2 nearest_on_triangle(const V3& a, const V3& b, const V3& c, const V3& p) {
    const V3 u = b - a, v = c - a, r = p - a, n = u.cross(v);
    const double s = r.cross(v).dot(n) / n.length2(), t = u.cross(r).dot(n) / n.length2();
    if (s >= 0 && t >= 0 && s + t <= 1) return {static_cast<float>(s), static_cast<float>(t)};
    Vec2 best(0, 0);
    double least = std::numeric_limits<double>::infinity();
    const auto try_edge = [&](const V3& from, const V3& to, const Vec2& at_from, const Vec2& at_to) {
        const V3 edge = to - from;
        const double k = std::clamp((p - from).dot(edge) / edge.length2(), 0.0, 1.0);
        if (const double d = (from + edge * k - p).length2(); d < least) {
            least = d;
            best = at_from * static_cast<float>(1 - k) + at_to * static_cast<float>(k);
        }
    };
    try_edge(a, b, {0, 0}, {1, 0});
    try_edge(b, c, {1, 0}, {0, 1});
    try_edge(c, a, {0, 1}, {0, 0});
    return best;
}

NearestEmitter nearest_on(const Sphere& sphere, const V3& p, const V3& towards) {
    const V3 out = p - V3(sphere.center);
    const bool deep = out.length() < 0.5 * sphere.radius;
    const Vec3 w((deep ? towards - V3(sphere.center) : out).normalized());
    return {sphere_point(sphere, w), std::max(0.0, out.length() - sphere.radius)};
}

NearestEmitter nearest_on(const TriangleMesh& mesh, const V3& p) {
    NearestEmitter best{{}, std::numeric_limits<double>::infinity()};
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const Vec2 at = nearest_on_triangle(V3(mesh.positions[a]), V3(mesh.positions[b]), V3(mesh.positions[c]), p);
        const SurfacePoint point = triangle_point(mesh, i, at.x, at.y);
        if (const double d = (V3(point.p) - p).length(); d < best.distance) best = {point, d};
    }
    return best;
}

} // namespace

std::optional<NearestEmitter> nearest_emitter_point(const Scene& scene, const V3& p, const V3& towards) {
    std::optional<NearestEmitter> best;
    const auto take = [&](const NearestEmitter& found, std::uint32_t emitter) {
        if (best && found.distance >= best->distance) return;
        best = found;
        best->point.emitter = emitter;
    };
    for (std::uint32_t i = 0; i < scene.emitters().size(); ++i) {
        if (scene.emitter(i).site() != Site::point) continue;
        Rng unused(0, StreamPurpose::seed_choice, 0); // there is nothing to choose
        const SurfacePoint point = scene.emitter(i).sample_point(unused).point;
        take({point, (V3(point.p) - p).length()}, i);
    }
    for (std::size_t i = 0; i < scene.shapes().size(); ++i) {
        const std::uint32_t emitter = scene.emitter_of_shape(i);
        if (emitter == SurfacePoint::kNone) continue;
        const Shape& shape = scene.shapes()[i];
        const auto* sphere = std::get_if<Sphere>(&shape.geometry);
        NearestEmitter found =
            sphere != nullptr ? nearest_on(*sphere, p, towards) : nearest_on(std::get<TriangleMesh>(shape.geometry), p);
        found.point.shape = static_cast<std::uint32_t>(i);
        found.point.material = shape.material.get();
        take(found, emitter);
    }
    return best;
}

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
