#include "gather/visible_point.h"

namespace keyhole {

std::optional<VisiblePoint> visible_point(const GatherRays& rays, const Vec2& image, SampleSource& source) {
    const Scene& scene = rays.scene();
    const Camera& camera = scene.camera();
    Vertex v = sample_eye(scene, source);
    Vec3 w = camera.ray_direction(v.point, image);
    const double pixel = 1 / std::sqrt(camera.direction_pdf(w) * camera.window().pixels());
    double length = 0;
    for (int scatterings = 1; scatterings <= rays.max_scatterings(); ++scatterings) {
        const auto hit = next_vertex(scene, v, w);
        if (!hit || hit->point.site == Site::infinite) break;
        length += (hit->point.p - v.point.p).length();
        v = *hit;
        if (v.bsdf.traits().near_lambertian) return VisiblePoint{v, -w, pixel * length, scatterings};
        const auto next = continue_walk(v, -w, From::eye, source);
        if (!next || !is_specular(next->event)) break;
        w = next->w;
    }
    return std::nullopt;
}

Vec3 cache_normal(const Vertex& v, const Vec3& back) {
    const Vec3 n = v.bsdf.shading_normal();
    // By the geometric side: a shading normal may turn away from the eye at a silhouette.
    return n.dot(facing(v.point.ng, back)) < 0 ? -n : n;
}

} // namespace keyhole
