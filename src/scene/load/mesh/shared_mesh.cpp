#include "scene/geometry.h"
#include "scene/load/load_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace keyhole {
namespace {

/// Of a mesh: with fewer, rays would find boxes of copies more often than triangles, and a copy takes as much memory as
/// two or three.
constexpr std::size_t kLeastTriangles = 64;
/// Fewer triangles are built in tenths of a second and take some 10 MB, and rays that meet overlapping copies of fine
/// meshes take up to a fifth longer.
constexpr std::size_t kLeastSaved = 100'000;
/// Largest coordinate of an object whose triangles rays are told to meet: products of smaller ones leave floats.
constexpr double kLeastSize = 1e-6;

} // namespace

bool is_worth_sharing(std::size_t triangles, std::size_t copies) {
    return triangles >= kLeastTriangles && copies > 1 && (copies - 1) * triangles >= kLeastSaved;
}

SharedMesh::SharedMesh(TriangleMesh mesh) {
    for (const Vec3& p : mesh.positions) {
        const Vec3 size = absolute(p);
        largest_ = std::max<double>({largest_, size.x, size.y, size.z});
    }
    // As a Scene does with other meshes; but how small a triangle of the object is says nothing of its copies.
    const double scale = largest_ > 0 && largest_ < 1 ? 1 / largest_ : 1;
    std::erase_if(mesh.triangles, [&](const auto& t) { return !has_area(mesh, t, scale); });
    mark_flat_triangles(mesh);
    mesh_ = std::make_shared<const TriangleMesh>(std::move(mesh));
}

bool SharedMesh::stands_as_instance(const ObjectToWorld& to_world) const {
    double farthest = 0;
    for (int k = 0; k < 3; ++k) {
        const Transform& m = to_world.matrix();
        const double linear = std::abs(m[0][k]) + std::abs(m[1][k]) + std::abs(m[2][k]);
        farthest = std::max(farthest, largest_ * linear + std::abs(m[3][k]));
    }
    return to_world.rounds_little() && largest_ >= kLeastSize && farthest <= kMaxMeshCoordinate;
}

Geometry SharedMesh::placed(const std::shared_ptr<const ObjectToWorld>& to_world) const {
    MeshInstance instance{mesh_, to_world};
    if (stands_as_instance(*to_world)) return instance;
    return flattened(instance);
}

} // namespace keyhole
