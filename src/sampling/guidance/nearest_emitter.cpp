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

/// Of emitters' points the one to take, one after the other.
class Choice {
  public:
    Choice(const Scene& scene, const V3& towards, double reach) : scene_(scene), towards_(towards), reach_(reach) {}

    /// @param distance of `point` from the given place.
    void offer(const SurfacePoint& point, double distance) {
        const bool nearer = !best_ || distance < best_->distance, within = distance <= reach_;
        if (!nearer && (sends_ || !within)) return;
        const Vec3 w((towards_ - V3(point.p)).normalized());
        const bool sends = within && !is_black(scene_.emitter(point.emitter).radiance(point, w));
        if (sends == sends_ ? !nearer : sends_) return;
        best_ = {point, distance};
        sends_ = sends;
    }
    const std::optional<NearestEmitter>& best() const { return best_; }

  private:
    const Scene& scene_;
    V3 towards_;
    double reach_;
    std::optional<NearestEmitter> best_;
    bool sends_ = false; // light from there
};

/// Those of a shape that may be the one: offer(point, distance).
template <class Offer> void offer_points(const Sphere& sphere, const V3& p, const V3& towards, const Offer& offer) {
    const V3 center(sphere.center), out = p - center;
    const auto at = [&](const V3& w) { return sphere_point(sphere, Vec3(w.normalized())); };
    const double distance = std::max(0.0, out.length() - sphere.radius);
    if (!(out.length() < 0.5 * sphere.radius)) offer(at(out), distance);
    const SurfacePoint faces = at(towards - center);
    offer(faces, distance > 0 ? (V3(faces.p) - p).length() : 0);
}

template <class Offer> void offer_points(const TriangleMesh& mesh, const V3& p, const Offer& offer) {
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const Vec2 at = nearest_on_triangle(V3(mesh.positions[a]), V3(mesh.positions[b]), V3(mesh.positions[c]), p);
        const SurfacePoint point = triangle_point(mesh, i, at.x, at.y);
        offer(point, (V3(point.p) - p).length());
    }
}

} // namespace

std::optional<NearestEmitter> nearest_emitter_point(const Scene& scene, const V3& p, const V3& towards, double reach) {
    Choice choice(scene, towards, reach);
    for (std::uint32_t i = 0; i < scene.emitters().size(); ++i) {
        if (scene.emitter(i).site() != Site::point) continue;
        Rng unused(0, StreamPurpose::seed_choice, 0); // there is nothing to choose
        SurfacePoint point = scene.emitter(i).sample_point(unused).point;
        point.emitter = i;
        choice.offer(point, (V3(point.p) - p).length());
    }
    for (std::size_t i = 0; i < scene.shapes().size(); ++i) {
        const std::uint32_t emitter = scene.emitter_of_shape(i);
        if (emitter == SurfacePoint::kNone) continue;
        const Shape& shape = scene.shapes()[i];
        const auto offer = [&](SurfacePoint point, double distance) {
            point.shape = static_cast<std::uint32_t>(i);
            point.material = shape.material.get();
            point.emitter = emitter;
            choice.offer(point, distance);
        };
        if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
            offer_points(*sphere, p, towards, offer);
        else
            offer_points(std::get<TriangleMesh>(shape.geometry), p, offer);
    }
    return choice.best();
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
