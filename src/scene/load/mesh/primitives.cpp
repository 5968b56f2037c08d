#include "scene/load/load_mesh.h"

#include "scene/warp.h"

namespace keyhole {
namespace {

void append_parallelogram(TriangleMesh& mesh, const Vec3& corner, const Vec3& u, const Vec3& v) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {corner, corner + u, corner + u + v, corner + v});
    mesh.uvs.insert(mesh.uvs.end(), {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

} // namespace

void append_grid(TriangleMesh& mesh, std::uint32_t first, std::uint32_t columns, std::uint32_t rows) {
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            const std::uint32_t a = first + j * (columns + 1) + i, c = a + columns + 1;
            mesh.triangles.push_back({a, a + 1, c + 1});
            mesh.triangles.push_back({a, c + 1, c});
        }
    }
}

TriangleMesh make_parallelogram(const Vec3& corner, const Vec3& u, const Vec3& v) {
    TriangleMesh mesh;
    append_parallelogram(mesh, corner, u, v);
    return mesh;
}

TriangleMesh make_box(const Vec3& minimum, const Vec3& maximum) {
    const Vec3 size = maximum - minimum;
    TriangleMesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 u(0.0f), v(0.0f);
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        u[i] = size[i];
        v[j] = size[j];
        append_parallelogram(mesh, maximum, -u, -v); // u x v is +axis
        append_parallelogram(mesh, minimum, v, u);
    }
    return mesh;
}

TriangleMesh tessellate(const Sphere& sphere) {
    constexpr std::uint32_t kAround = 256, kDown = 128;
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= kDown; ++j) {
        const double theta = kPi * j / kDown;
        for (std::uint32_t i = 0; i <= kAround; ++i) {
            const Vec3 n = spherical(std::cos(theta), 2 * kPi * i / kAround);
            mesh.positions.push_back(sphere.center + n * sphere.radius);
            mesh.normals.push_back(n);
            mesh.uvs.emplace_back(static_cast<float>(i) / kAround, static_cast<float>(j) / kDown);
        }
    }
    for (std::uint32_t j = 0; j < kDown; ++j) {
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const std::uint32_t a = j * (kAround + 1) + i, b = a + 1, c = a + kAround + 1, d = c + 1;
            // At the poles one of the two triangles has no area.
            if (j > 0) mesh.triangles.push_back({a, c, b});
            if (j + 1 < kDown) mesh.triangles.push_back({b, c, d});
        }
    }
    return mesh;
}

} // namespace keyhole
