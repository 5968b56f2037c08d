#include "sampling/guidance/user_paths.h"

#include "scene/geometry.h"
#include "scene/warp.h"

#include <algorithm>

namespace keyhole {
namespace {

const Sphere* sphere_of(const Scene& scene, const SurfacePoint& point) {
    return std::get_if<Sphere>(&scene.shapes()[point.shape].geometry);
}

} // namespace

EmitterPatch::EmitterPatch(const Scene& scene, const SurfacePoint& center, std::optional<double> radius)
    : scene_(&scene), center_(center), whole_(!radius) {
    if (is_whole()) return;
    if (const Sphere* sphere = sphere_of(scene, center)) {
        const double angle = std::min(kPi, *radius / sphere->radius), s = std::sin(angle / 2);
        cosine_ = std::cos(angle);
        area_ = 4 * kPi * sphere->radius * sphere->radius * s * s;
        return;
    }
    const auto& mesh = std::get<TriangleMesh>(scene.shapes()[center.shape].geometry);
    double farthest = 0;
    for (const auto corner : mesh.triangles[center.primitive])
        farthest = std::max<double>(farthest, (mesh.positions[corner] - center.p).length());
    scale_ = std::min(1.0, *radius / farthest);
    area_ = scale_ * scale_ * triangle_area(mesh, center.primitive);
    center_barycentric_ = barycentric(center.p);
}

Vec2 EmitterPatch::barycentric(const Vec3& p) const {
    const auto& mesh = std::get<TriangleMesh>(scene_->shapes()[center_.shape].geometry);
    const auto& [ia, ib, ic] = mesh.triangles[center_.primitive];
    const Imath::V3d a(mesh.positions[ia]), u = Imath::V3d(mesh.positions[ib]) - a,
                                            v = Imath::V3d(mesh.positions[ic]) - a, r = Imath::V3d(p) - a;
    const Imath::V3d n = u.cross(v);
    return {static_cast<float>(r.cross(v).dot(n) / n.length2()), static_cast<float>(u.cross(r).dot(n) / n.length2())};
}

SurfacePoint EmitterPatch::sample(SampleSource& source) const {
    SurfacePoint point;
    if (is_whole()) {
        point = scene_->emitter(center_.emitter).sample_point(source).point;
    } else if (const Sphere* sphere = sphere_of(*scene_, center_)) {
        const double u0 = source.next(), u1 = source.next();
        const Vec3 axis = (center_.p - sphere->center).normalized();
        point = sphere_point(*sphere, Frame(axis).to_world(uniform_cone(u0, u1, cosine_)).normalized());
    } else {
        const double u0 = source.next(), u1 = source.next();
        const auto s = static_cast<float>(scale_);
        const Vec2 b = uniform_triangle(u0, u1) * s + center_barycentric_ * (1 - s);
        point = triangle_point(std::get<TriangleMesh>(scene_->shapes()[center_.shape].geometry), center_.primitive, b.x,
                               b.y);
    }
    point.shape = center_.shape;
    point.emitter = center_.emitter;
    point.material = center_.material;
    return point;
}

double EmitterPatch::pdf(const SurfacePoint& point) const {
    if (point.emitter != center_.emitter) return 0;
    if (is_whole()) return scene_->emitter(center_.emitter).point_pdf(point);
    if (point.primitive != center_.primitive) return 0;
    if (const Sphere* sphere = sphere_of(*scene_, center_)) {
        const Vec3 axis = (center_.p - sphere->center).normalized();
        return in_cone((point.p - sphere->center).normalized(), axis, cosine_) ? 1 / area_ : 0.0;
    }
    const auto s = static_cast<float>(scale_);
    const Vec2 b = (barycentric(point.p) - center_barycentric_ * (1 - s)) / s;
    return b.x >= 0 && b.y >= 0 && b.x + b.y <= 1 ? 1 / area_ : 0.0;
}

} // namespace keyhole
