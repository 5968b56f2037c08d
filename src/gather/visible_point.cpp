#include "gather/visible_point.h"

#include "sampling/paths/random_walk.h"
#include "scene/warp.h"

namespace keyhole {
namespace {

struct VisiblePointWalk : SpecularWalkHooks {
    std::optional<VisiblePoint> found{};
    LastTwoVertices vertices{};
    double length = 0;
    int scatterings = 0;

    Vertex& place() { return vertices.place(); }
    bool arrive(const Vertex& v, const WalkRay& ray) {
        if (v.point.site == Site::infinite) return false;
        ++scatterings;
        length += (v.point.p - ray.last->p).length();
        const BsdfTraits traits = v.bsdf.traits();
        if (traits.diffuse) found = {v, -ray.w, length, scatterings};
        return !found || traits.delta;
    }
    bool leave(const Vertex& /*v*/, const Continuation& next, const WalkRay& /*ray*/) {
        if (is_specular(next.event)) found.reset();
        return is_specular(next.event);
    }
};

} // namespace

std::optional<VisiblePoint> visible_point(const GatherRays& rays, const Vec2& image, SampleSource& source) {
    const Scene& scene = rays.scene();
    const Camera& camera = scene.camera();
    const Vertex eye = sample_eye(scene, source);
    const WalkRay ray = eye_ray(scene, eye.point, image);
    VisiblePointWalk walk;
    random_walk(scene, From::eye, ray, rays.max_scatterings(), source, walk);
    if (walk.found) walk.found->pixel *= 1 / std::sqrt(camera.direction_pdf(ray.w) * camera.window().pixels());
    return walk.found;
}

std::optional<FirstGatherRay> first_gather_ray(const GatherRays& rays, const Vec2& image, SampleSource& source) {
    const auto from = visible_point(rays, image, source);
    if (!from) return std::nullopt;
    const auto [u0, u1] = source.take<2>();
    const Vec3 local = cosine_hemisphere(u0, u1);
    const Vec3 w = Frame(cache_normal(from->vertex, from->back)).to_world(local);
    if (!from->leaves(w)) return std::nullopt;
    return FirstGatherRay{*from, w, local.z * kInvPi};
}

Vec3 cache_normal(const Vertex& v, const Vec3& back) {
    const Vec3 n = v.bsdf.shading_normal();
    // By the geometric side: a shading normal may turn away from the eye at a silhouette.
    return n.dot(facing(v.point.ng, back)) < 0 ? -n : n;
}

} // namespace keyhole
