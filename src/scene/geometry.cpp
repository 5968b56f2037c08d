#include "scene/geometry.h"

#include <algorithm>
#include <limits>
#include <string_view>

namespace keyhole {
namespace {

Vec3 absolute(const Vec3& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

/// Bounds both the rounding of an interpolated position and that of the next intersection test, relative to the sizes
/// of the numbers that went in (Pharr, Jakob, Humphreys, "Managing Rounding Error": gamma_7 is 4e-7 in float).
constexpr float kRelativeError = 1.5e-6f;

/// Sets the tangent and the derivatives of position by texture coordinates; needs ns.
void set_parametrisation(SurfacePoint& s, const Vec3& dpdu, const Vec3& dpdv) {
    const Vec3 along = dpdu - s.ns * dpdu.dot(s.ns);
    s.dpdu = along.length();
    s.tangent = s.dpdu > 0 ? along / s.dpdu : Frame(s.ns).s;
    s.dpdv = {dpdv.dot(s.tangent), dpdv.dot(s.ns.cross(s.tangent))};
}

void parametrise(SurfacePoint& s, const TriangleMesh& mesh, float u, float v) {
    const auto& [ia, ib, ic] = mesh.triangles[s.primitive];
    const Vec3 &a = mesh.positions[ia], &b = mesh.positions[ib], &c = mesh.positions[ic];
    s.uv = Vec2(u, v);
    Vec3 dpdu = b - a, dpdv = c - a;
    if (!mesh.uvs.empty()) {
        const Vec2 &ta = mesh.uvs[ia], &tb = mesh.uvs[ib], &tc = mesh.uvs[ic];
        s.uv = ta * (1 - u - v) + tb * u + tc * v;
        const float det = (tb.x - ta.x) * (tc.y - ta.y) - (tc.x - ta.x) * (tb.y - ta.y);
        if (det != 0) {
            dpdu = ((b - a) * (tc.y - ta.y) - (c - a) * (tb.y - ta.y)) / det;
            dpdv = ((c - a) * (tb.x - ta.x) - (b - a) * (tc.x - ta.x)) / det;
        }
    }
    set_parametrisation(s, dpdu, dpdv);
}

void parametrise(SurfacePoint& s, const Sphere& sphere, const Vec3& outward) {
    const float phi = std::atan2(outward.y, outward.x);
    s.uv = Vec2(static_cast<float>((phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi)),
                static_cast<float>(std::acos(std::clamp(outward.z, -1.0f, 1.0f)) / kPi));
    const Vec3 pole = Vec3(outward.x, outward.y, 0).normalized();
    const float sine = std::hypot(outward.x, outward.y), r = sphere.radius * static_cast<float>(kPi);
    set_parametrisation(s, Vec3(-outward.y, outward.x, 0) * (2 * r), (pole * outward.z - Vec3(0, 0, sine)) * r);
}

} // namespace

float rounding_along(const Vec3& n, const Vec3& p) { return kRelativeError * absolute(n).dot(absolute(p)); }

SurfacePoint triangle_point(const TriangleMesh& mesh, std::uint32_t triangle, float u, float v, bool parametrised) {
    const auto& [ia, ib, ic] = mesh.triangles[triangle];
    const Vec3 &a = mesh.positions[ia], &b = mesh.positions[ib], &c = mesh.positions[ic];
    const float w = 1 - u - v;
    SurfacePoint s;
    s.p = a * w + b * u + c * v;
    // Lengths to the fourth power, which floats don't hold for all that may be in a scene.
    const Imath::V3d n = Imath::V3d(b - a).cross(Imath::V3d(c - a));
    s.ng = Vec3(n * (1 / std::max(n.length(), std::numeric_limits<double>::min())));
    s.offset = kRelativeError * absolute(s.ng).dot(absolute(a) * w + absolute(b) * u + absolute(c) * v);
    s.ns = s.ng;
    s.primitive = triangle;
    if (!mesh.normals.empty()) {
        s.ns = (mesh.normals[ia] * w + mesh.normals[ib] * u + mesh.normals[ic] * v).normalized();
        if (s.ns.length2() == 0) s.ns = s.ng;
        if (s.ns.dot(s.ng) < 0) s.ns = -s.ns;
    }
    if (parametrised) parametrise(s, mesh, u, v);
    return s;
}

SurfacePoint sphere_point(const Sphere& sphere, const Vec3& outward, bool parametrised) {
    SurfacePoint s;
    s.p = sphere.center + outward * sphere.radius;
    s.ng = s.ns = sphere.inward ? -outward : outward;
    s.offset = kRelativeError * (absolute(s.ng).dot(absolute(sphere.center)) + sphere.radius);
    s.primitive = 0;
    if (parametrised) parametrise(s, sphere, outward);
    return s;
}

double triangle_area(const TriangleMesh& mesh, std::uint32_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Imath::V3d e(mesh.positions[b] - mesh.positions[a]), f(mesh.positions[c] - mesh.positions[a]);
    return e.cross(f).length() / 2;
}

bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const Vec3& a = mesh.positions[triangle[0]];
    const Imath::V3d n = Imath::V3d(mesh.positions[triangle[1]] - a).cross(Imath::V3d(mesh.positions[triangle[2]] - a));
    return n.length2() > std::numeric_limits<float>::min();
}

bool has_area(const std::variant<TriangleMesh, Sphere>& geometry) {
    const auto* mesh = std::get_if<TriangleMesh>(&geometry);
    return mesh == nullptr || std::ranges::any_of(mesh->triangles, [&](const auto& t) { return has_area(*mesh, t); });
}

double surface_area(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
        const double r = sphere->radius;
        return 4 * kPi * r * r;
    }
    const auto& mesh = std::get<TriangleMesh>(shape.geometry);
    double area = 0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) area += triangle_area(mesh, i);
    return area;
}

std::size_t geometry_bytes(const Shape& shape) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    if (mesh == nullptr) return sizeof(Sphere);
    const auto bytes = [](const auto& list) { return list.size() * sizeof(list[0]); };
    return bytes(mesh->positions) + bytes(mesh->normals) + bytes(mesh->uvs) + bytes(mesh->triangles);
}

bool is_invisible_light(const Shape& shape) {
    return shape.emission && shape.alpha && shape.alpha->is_constant() && !(shape.alpha->value({}) > 0);
}

void drop_needless_normals(Shape& shape) {
    constexpr double kAlike = 1 - 1e-8; // cosine: normals as files have them, rounded
    auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    if (mesh == nullptr) return;
    for (std::uint32_t i = 0; i < mesh->triangles.size() && !mesh->normals.empty(); ++i) {
        const Imath::V3d ng(triangle_point(*mesh, i, 0.25f, 0.25f, false).ng);
        for (const std::uint32_t corner : mesh->triangles[i])
            if (!(std::abs(Imath::V3d(mesh->normals[corner]).normalized().dot(ng)) > kAlike)) return;
    }
    mesh->normals.clear();
}

bool may_be_clear(const Shape& shape) {
    const ClearGlass glass = shape.material->traits().clear;
    const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    if (glass != ClearGlass::face) return glass == ClearGlass::pane;
    if (mesh == nullptr || mesh->normals.empty()) return mesh != nullptr;
    return std::ranges::any_of(mesh->triangles, [&](const auto& corners) {
        const auto& [a, b, c] = corners;
        return mesh->normals[a] == mesh->normals[b] && mesh->normals[a] == mesh->normals[c];
    });
}

bool is_interface(const Shape& shape) {
    if (shape.emission) return false;
    return shape.material ? std::string_view(shape.material->kind()) == "interface" : bounds_media(shape);
}

} // namespace keyhole
