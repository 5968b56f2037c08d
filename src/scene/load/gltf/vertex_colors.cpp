#include "scene/load/gltf/vertex_colors.h"

#include "scene/textures/function_texture.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace keyhole::gltf {
namespace {

/// A mesh with a value at each position. Textures outlive the mesh that a file is read into.
class VertexValues {
  public:
    explicit VertexValues(const MeshPart& part) : VertexValues(std::get<TriangleMesh>(part.geometry), part.colors) {}
    VertexValues(const TriangleMesh& mesh, const std::vector<Imath::V4f>& values)
        : positions_(mesh.positions), triangles_(mesh.triangles), values_(values) {}

    /// Red, green, blue and opacity; 1 at points of no triangle.
    Imath::V4d value(const SurfacePoint& point) const {
        if (point.primitive >= triangles_.size()) return Imath::V4d(1);
        const auto& t = triangles_[point.primitive];
        const Imath::V3d weights = barycentric(Imath::V3d(point.p), t);
        Imath::V4d sum(0);
        for (int k = 0; k < 3; ++k) sum += Imath::V4d(values_[t[k]]) * weights[k];
        return sum;
    }

  private:
    /// Of the foot of a point in the plane of a triangle, within it.
    Imath::V3d barycentric(const Imath::V3d& p, const std::array<std::uint32_t, 3>& t) const {
        const Imath::V3d a(positions_[t[0]]), b(positions_[t[1]]), c(positions_[t[2]]);
        const Imath::V3d n = (b - a).cross(c - a);
        const double u = std::clamp(n.dot((p - a).cross(c - a)) / n.length2(), 0.0, 1.0),
                     v = std::clamp(n.dot((b - a).cross(p - a)) / n.length2(), 0.0, 1 - u);
        return {1 - u - v, u, v};
    }

    std::vector<Vec3> positions_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<Imath::V4f> values_;
};

template <class Is> bool any(const MeshPart& part, Is&& is) { return std::ranges::any_of(part.colors, is); }

} // namespace

VertexColors vertex_colors(const MeshPart& part) {
    VertexColors colors;
    const bool tinted = any(part, [](const Imath::V4f&c) { return c.x != 1 || c.y != 1 || c.z != 1; }),
               clear = any(part, [](const Imath::V4f&c) { return c.w != 1; });
    if (!tinted && !clear) return colors;
    const auto values = std::make_shared<VertexValues>(part);
    if (tinted)
        colors.color = function_texture<Rgb>([values](const SurfacePoint& point) {
            const Imath::V4d value = values->value(point);
            return Rgb(value.x, value.y, value.z);
        });
    if (clear)
        colors.opacity =
            function_texture<double>([values](const SurfacePoint& point) { return values->value(point).w; });
    return colors;
}

} // namespace keyhole::gltf
