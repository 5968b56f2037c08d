#include "scene/load/load_mesh.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

/// Along the normal, as long as twice the area; in double, so that no triangle of floats but a degenerate one gives 0.
Imath::V3d area_vector(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
    const auto& p = mesh.positions;
    const Imath::V3d a(p[t[0]]);
    return (Imath::V3d(p[t[1]]) - a).cross(Imath::V3d(p[t[2]]) - a);
}

bool is_unit_like(const Vec3& n) {
    const float l = n.length2();
    return l > 0.25f && l < 4; // false for NaN
}

void check(const TriangleMesh& mesh, const std::string& source) {
    for (const Vec3& p : mesh.positions)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(p[axis]) <= kMaxMeshCoordinate))
                throw InputError({source, 0, 0},
                                 fmt::format("found the coordinate {}, expected one within 1e12", p[axis]));
    const auto n = mesh.positions.size();
    for (const auto& t : mesh.triangles)
        for (const auto i : t)
            if (i >= n)
                throw InputError({source, 0, 0}, fmt::format("found the vertex index {}, expected one below {}", i, n));
}

/// Files hold zero and NaN normals more often than one thinks.
void mend_normals(TriangleMesh& mesh) {
    if (mesh.normals.empty()) return;
    for (const auto& t : mesh.triangles)
        for (const auto i : t)
            if (!is_unit_like(mesh.normals[i])) mesh.normals[i] = Vec3(area_vector(mesh, t).normalized());
    for (Vec3& n : mesh.normals) n = is_unit_like(n) ? n.normalized() : Vec3(0, 0, 1); // the latter: of no triangle
}

} // namespace

void mend_mesh(TriangleMesh& mesh, const std::string& source) {
    check(mesh, source);
    std::erase_if(mesh.triangles, [&](const auto& t) { return area_vector(mesh, t).length2() == 0; });
    mend_normals(mesh);
    for (Vec2& uv : mesh.uvs)
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = {0, 0};
}

void smooth_normals(TriangleMesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), Vec3(0.0f));
    for (const auto& t : mesh.triangles) {
        const Vec3 n(area_vector(mesh, t).normalized());
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& p = mesh.positions[t[k]];
            const Vec3 a = (mesh.positions[t[(k + 1) % 3]] - p).normalized();
            const Vec3 b = (mesh.positions[t[(k + 2) % 3]] - p).normalized();
            mesh.normals[t[k]] += n * std::acos(std::clamp(a.dot(b), -1.0f, 1.0f));
        }
    }
    for (Vec3& n : mesh.normals) n.normalize();
    mend_normals(mesh); // where normals cancel
}

} // namespace keyhole
