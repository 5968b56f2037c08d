#include "scene/geometry.h"
#include "scene/load/load_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace keyhole {
namespace {

/// Whether `t` scales all directions by the same factor.
bool is_uniform(const Transform& t) {
    const Imath::V3d x = row_of(t, 0), y = row_of(t, 1), z = row_of(t, 2);
    const double s = x.length2(), tolerance = 1e-6 * s;
    return std::abs(y.length2() - s) < tolerance && std::abs(z.length2() - s) < tolerance &&
           std::abs(x.dot(y)) < tolerance && std::abs(y.dot(z)) < tolerance && std::abs(z.dot(x)) < tolerance;
}

} // namespace

double regularity(const Transform& t) {
    const double product = row_of(t, 0).length() * row_of(t, 1).length() * row_of(t, 2).length();
    return product > 0 ? std::abs(linear_determinant(t)) / product : 0.0;
}

void transform_geometry(Geometry& geometry, const Transform& t) {
    if (const auto* sphere = std::get_if<Sphere>(&geometry)) {
        if (is_uniform(t)) {
            geometry = Sphere{Vec3(Imath::V3d(sphere->center) * t),
                              static_cast<float>(sphere->radius * row_of(t, 0).length()), sphere->inward};
            return;
        }
        const bool inward = sphere->inward;
        geometry = tessellate(*sphere);
        if (inward) flip(geometry);
    }
    transform_mesh(std::get<TriangleMesh>(geometry), t);
}

bool has_bounded_positions(const Geometry& geometry) {
    const auto bounded = [](const Vec3& p) {
        constexpr float kMost = 1e13f;
        return std::abs(p.x) <= kMost && std::abs(p.y) <= kMost && std::abs(p.z) <= kMost;
    };
    if (const auto* s = std::get_if<Sphere>(&geometry)) return bounded(s->center) && bounded(Vec3(s->radius));
    return std::ranges::all_of(std::get<TriangleMesh>(geometry).positions, bounded);
}

void flip(Geometry& geometry) {
    if (auto* sphere = std::get_if<Sphere>(&geometry)) {
        sphere->inward = !sphere->inward;
        return;
    }
    auto& mesh = std::get<TriangleMesh>(geometry);
    reverse_winding(mesh);
    for (Vec3& n : mesh.normals) n = -n;
}

} // namespace keyhole
