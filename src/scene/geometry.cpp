#include "scene/geometry.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

namespace keyhole {
namespace {

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

using Corners = std::array<std::uint32_t, 3>;

/// @param ab,ac edges of the triangle
void parametrise(SurfacePoint& s, const TriangleMesh& mesh, const Corners& corners, const Vec3& ab, const Vec3& ac,
                 const Vec2& at) {
    s.uv = at;
    Vec3 dpdu = ab, dpdv = ac;
    if (!mesh.uvs.empty()) {
        const Vec2 &ta = mesh.uvs[corners[0]], &tb = mesh.uvs[corners[1]], &tc = mesh.uvs[corners[2]];
        s.uv = ta * (1 - at.x - at.y) + tb * at.x + tc * at.y;
        const float det = (tb.x - ta.x) * (tc.y - ta.y) - (tc.x - ta.x) * (tb.y - ta.y);
        if (det != 0) {
            dpdu = (ab * (tc.y - ta.y) - ac * (tb.y - ta.y)) / det;
            dpdv = (ac * (tb.x - ta.x) - ab * (tc.x - ta.x)) / det;
        }
    }
    set_parametrisation(s, dpdu, dpdv);
}

/// Of a mesh that stands in the world.
struct InPlace {
    const Vec3& point(const Vec3& p) const { return p; }
    const Vec3& normal(const Vec3& n) const { return n; }
    float rounding_along(const Vec3& /*n*/, const Vec3& /*size*/) const { return 0; }
};

Imath::V3d edge_of(const Vec3& from, const Vec3& to, const InPlace& /*to_world*/) { return Imath::V3d(to - from); }
/// Not rounded to where it stands, so that triangles of an object all have normals.
Imath::V3d edge_of(const Vec3& from, const Vec3& to, const ObjectToWorld& to_world) {
    return to_world.direction(Imath::V3d(to) - Imath::V3d(from));
}

/// Anticlockwise from outside, in the world.
const Corners& corners_of(const TriangleMesh& mesh, std::uint32_t triangle, const InPlace& /*to_world*/) {
    return mesh.triangles[triangle];
}
Corners corners_of(const TriangleMesh& mesh, std::uint32_t triangle, const ObjectToWorld& to_world) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return to_world.is_mirrored() ? Corners{a, c, b} : Corners{a, b, c};
}

template <class ToWorld>
[[gnu::always_inline]] inline SurfacePoint point_of(const TriangleMesh& mesh, std::uint32_t triangle,
                                                    const ToWorld& to_world, float u, float v, bool parametrised) {
    const Corners& corners = corners_of(mesh, triangle, to_world);
    const Vec3 &pa = mesh.positions[corners[0]], &pb = mesh.positions[corners[1]], &pc = mesh.positions[corners[2]];
    const auto &a = to_world.point(pa), &b = to_world.point(pb), &c = to_world.point(pc);
    const float w = 1 - u - v;
    SurfacePoint s;
    s.p = a * w + b * u + c * v;
    // Lengths to the fourth power, which floats don't hold for all that may be in a scene.
    const Imath::V3d ab = edge_of(pa, pb, to_world), ac = edge_of(pa, pc, to_world), n = ab.cross(ac);
    s.ng = Vec3(n * (1 / std::max(n.length(), std::numeric_limits<double>::min())));
    const Vec3 size = absolute(a) * w + absolute(b) * u + absolute(c) * v;
    s.offset = kRelativeError * absolute(s.ng).dot(size) + to_world.rounding_along(s.ng, size);
    s.ns = s.ng;
    s.primitive = triangle;
    if (!mesh.normals.empty() && !(!mesh.flat.empty() && mesh.flat[triangle])) {
        const auto normal = [&](std::size_t k) { return to_world.normal(mesh.normals[corners[k]]); };
        s.ns = (normal(0) * w + normal(1) * u + normal(2) * v).normalized();
        if (s.ns.length2() == 0) s.ns = s.ng;
        if (s.ns.dot(s.ng) < 0) s.ns = -s.ns;
    }
    if (parametrised) parametrise(s, mesh, corners, Vec3(ab), Vec3(ac), {u, v});
    return s;
}

/// What `f(mesh, to_world)` says of the triangles of a shape.
template <class F> auto of_triangles(const Shape& shape, F&& f) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) return f(*mesh, InPlace());
    const auto& instance = std::get<MeshInstance>(shape.geometry);
    return f(*instance.mesh, *instance.to_world);
}

/// Whether the normals at the corners of a triangle, of either side, are that of its face but for rounding.
bool has_normals_of_face(const TriangleMesh& mesh, const Corners& corners) {
    // What tells a facet of a curved surface from a flat face is that its normals differ among themselves. Those of one
    // face are the same numbers, unless they are means over its parts; then text of four digits, say, makes them differ
    // by 1.7e-4 rad. A curved mesh would need 30,000 facets in a circle to be as fine; taken as flat, these turn what
    // they reflect by 4e-4 rad at most, and what goes through two of them by half of that: 2 mm in 10 m.
    constexpr double kBend = 2e-4;
    // All together they may be off by more: in 8 bits by 7e-3 rad; and the face's own normal is off by 1e-2 where it is
    // a tenth of a millimetre wide and its positions are floats of 10 m. Such a tilt bends nothing, and whether two
    // faces are parallel is for their positions to say.
    constexpr double kTilt = 1e-2;
    const auto position = [&](std::size_t k) { return Imath::V3d(mesh.positions[corners[k]]); };
    const Imath::V3d a = position(0), face = (position(1) - a).cross(position(2) - a).normalized();
    std::array<Imath::V3d, 3> n;
    for (std::size_t k = 0; k < 3; ++k) {
        n[k] = Imath::V3d(mesh.normals[corners[k]]).normalized();
        if (n[k].dot(face) < 0) n[k] = -n[k];
        if (!((n[k] - face).length() <= kTilt)) return false;
    }
    const auto alike = [&](std::size_t i, std::size_t k) { return (n[i] - n[k]).length() <= kBend; };
    return alike(0, 1) && alike(1, 2) && alike(2, 0);
}

double area_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    return Imath::V3d(b - a).cross(Imath::V3d(c - a)).length() / 2;
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
    return point_of(mesh, triangle, InPlace(), u, v, parametrised);
}

SurfacePoint triangle_point(const Shape& shape, std::uint32_t triangle, float u, float v, bool parametrised) {
    return of_triangles(shape, [&](const TriangleMesh& mesh, const auto& to_world) {
        return point_of(mesh, triangle, to_world, u, v, parametrised);
    });
}

std::array<Vec3, 3> triangle_corners(const Shape& shape, std::uint32_t triangle) {
    return of_triangles(shape, [&](const TriangleMesh& mesh, const auto& to_world) {
        const auto [a, b, c] = corners_of(mesh, triangle, to_world);
        return std::array<Vec3, 3>{to_world.point(mesh.positions[a]), to_world.point(mesh.positions[b]),
                                   to_world.point(mesh.positions[c])};
    });
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
    return area_of(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
}

double triangle_area(const Shape& shape, std::uint32_t triangle) {
    const auto [a, b, c] = triangle_corners(shape, triangle);
    return area_of(a, b, c);
}

bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle, double scale) {
    const Vec3& a = mesh.positions[triangle[0]];
    const Imath::V3d ab(mesh.positions[triangle[1]] - a), ac(mesh.positions[triangle[2]] - a);
    const Imath::V3d n = (ab * scale).cross(ac * scale);
    return n.length2() > std::numeric_limits<float>::min();
}

bool has_area(const Geometry& geometry) {
    const auto any = [](const TriangleMesh& mesh) {
        return std::ranges::any_of(mesh.triangles, [&](const auto& t) { return has_area(mesh, t); });
    };
    if (const auto* instance = std::get_if<MeshInstance>(&geometry)) return !instance->mesh->triangles.empty();
    const auto* mesh = std::get_if<TriangleMesh>(&geometry);
    return mesh == nullptr || any(*mesh);
}

const TriangleMesh* held_mesh(const Shape& shape) {
    if (const auto* instance = std::get_if<MeshInstance>(&shape.geometry)) return instance->mesh.get();
    return std::get_if<TriangleMesh>(&shape.geometry);
}

std::set<const TriangleMesh*> held_meshes(const std::vector<Shape>& shapes) {
    std::set<const TriangleMesh*> meshes;
    for (const Shape& shape : shapes) meshes.insert(held_mesh(shape));
    meshes.erase(nullptr);
    return meshes;
}

std::size_t geometry_bytes(const std::vector<Shape>& shapes) {
    const auto bytes = [](const auto& list) { return list.size() * sizeof(list[0]); };
    std::size_t sum = 0;
    for (const TriangleMesh* mesh : held_meshes(shapes))
        sum += bytes(mesh->positions) + bytes(mesh->normals) + bytes(mesh->uvs) + bytes(mesh->triangles) +
               mesh->flat.size() / 8;
    std::set<const ObjectToWorld*> copies;
    for (const Shape& shape : shapes) {
        if (std::holds_alternative<Sphere>(shape.geometry)) sum += sizeof(Sphere);
        if (const auto* instance = std::get_if<MeshInstance>(&shape.geometry)) copies.insert(instance->to_world.get());
    }
    return sum + copies.size() * sizeof(ObjectToWorld);
}

std::size_t triangle_count(const Shape& shape) {
    const TriangleMesh* mesh = held_mesh(shape);
    return mesh != nullptr ? mesh->triangles.size() : 0;
}

double surface_area(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
        const double r = sphere->radius;
        return 4 * kPi * r * r;
    }
    double area = 0;
    for (std::uint32_t i = 0; i < triangle_count(shape); ++i) area += triangle_area(shape, i);
    return area;
}

void transform_mesh(TriangleMesh& mesh, const ObjectToWorld& to_world) {
    for (Vec3& p : mesh.positions) p = to_world.point(p);
    for (Vec3& n : mesh.normals) n = to_world.normal(n);
    if (to_world.is_mirrored()) reverse_winding(mesh);
}

void reverse_winding(TriangleMesh& mesh) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

TriangleMesh flattened(const MeshInstance& instance) {
    TriangleMesh mesh = *instance.mesh;
    mesh.flat.clear();
    transform_mesh(mesh, *instance.to_world);
    return mesh;
}

bool is_invisible_light(const Shape& shape) {
    return shape.emission && shape.alpha && shape.alpha->is_constant() && !(shape.alpha->value({}) > 0);
}

void mark_flat_triangles(TriangleMesh& mesh) {
    mesh.flat.clear();
    if (mesh.normals.empty()) return;
    std::vector<bool> flat;
    flat.reserve(mesh.triangles.size());
    for (const Corners& corners : mesh.triangles) flat.push_back(has_normals_of_face(mesh, corners));
    const auto found = std::ranges::count(flat, true);
    if (found == std::ssize(flat))
        mesh.normals.clear();
    else if (found > 0)
        mesh.flat = std::move(flat);
}

bool is_flat_in_part(const TriangleMesh& mesh) {
    return mesh.normals.empty() || std::ranges::any_of(mesh.triangles, [&](const Corners& corners) {
               return has_normals_of_face(mesh, corners);
           });
}

bool is_interface(const Shape& shape) {
    if (shape.emission) return false;
    return shape.material ? std::string_view(shape.material->kind()) == "interface" : bounds_media(shape);
}

} // namespace keyhole
