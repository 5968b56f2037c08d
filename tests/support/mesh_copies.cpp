#include "support/mesh_copies.h"

#include "core/rng.h"
#include "scene/geometry.h"
#include "scene/load/load_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace keyhole::test {

TriangleMesh dented_ball(std::uint32_t columns, std::uint32_t rows) {
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= rows; ++j)
        for (std::uint32_t i = 0; i <= columns; ++i) {
            const double sine = j == rows ? 0 : std::sin(kPi * j / rows); // at the pole one place
            const double u = double(i) / columns, v = double(j) / rows;
            const double phi = 2 * kPi * (i == columns ? 0 : u), theta = kPi * v,
                         r = 0.4 + 0.1 * std::sin(3 * phi) * sine;
            mesh.positions.emplace_back(0.1 + r * sine * std::cos(phi), r * std::cos(theta) - 0.2,
                                        r * sine * std::sin(phi));
            mesh.uvs.emplace_back(static_cast<float>(u), static_cast<float>(v));
        }
    append_grid(mesh, 0, columns, rows);
    std::erase_if(mesh.triangles, [&](const auto& t) { return !has_area(mesh, t); });
    smooth_normals(mesh);
    return mesh;
}

Imath::M44d random_transform(std::uint64_t seed, bool mirrored) {
    Rng rng(seed, StreamPurpose::test, 77);
    for (;;) {
        Imath::M44d m;
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) m[i][k] = 2 * rng.next() - 1;
        if (regularity(m) < 0.2) continue;
        if ((m.determinant() < 0) != mirrored)
            for (int k = 0; k < 3; ++k) m[0][k] = -m[0][k];
        if (ObjectToWorld(m).rounds_little()) return m;
    }
}

Imath::M44d moved(const Imath::M44d& transform, double scale, const Imath::V3d& by) {
    return transform * Imath::M44d().setScale(scale) * Imath::M44d().setTranslation(by);
}

Shape instance_of(const std::shared_ptr<const TriangleMesh>& mesh, const std::shared_ptr<const ObjectToWorld>& to_world,
                  std::shared_ptr<const Material> material) {
    return {.geometry = MeshInstance{mesh, to_world}, .material = std::move(material), .emission = nullptr};
}

std::unique_ptr<Scene> scene_of(std::vector<Shape> shapes) {
    SceneDescription d;
    d.shapes = std::move(shapes);
    return std::make_unique<Scene>(std::move(d));
}

std::vector<Shape> without_instances(const std::vector<Shape>& shapes) {
    std::vector<Shape> all;
    for (const Shape& s : shapes) {
        const auto* instance = std::get_if<MeshInstance>(&s.geometry);
        all.push_back({.geometry = instance != nullptr ? Geometry(flattened(*instance)) : s.geometry,
                       .material = s.material,
                       .emission = s.emission ? std::make_unique<SurfaceEmission>(*s.emission) : nullptr,
                       .alpha = s.alpha,
                       .inside = s.inside,
                       .outside = s.outside});
    }
    return all;
}

std::string obj_text(const TriangleMesh& mesh) {
    std::string text;
    for (const Vec3& p : mesh.positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
    return text;
}

} // namespace keyhole::test
