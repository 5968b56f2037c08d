#include "scene/load/pbrt/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyhole::pbrt {
namespace {

constexpr std::uint32_t kAround = 128, kAlong = 64; // facets; they lie within 3e-4 radii

/// A point of a surface of revolution about z, before it is turned by phi.
struct ProfilePoint {
    double radius, z;
    double normal_radius, normal_z;
};

/// Turns `profile(v)`, v in [0,1], about z, from 0 to `phi_max`. The outside is where u (along phi) x v points to.
template <class Profile> TriangleMesh revolve(std::uint32_t along, double phi_max, const Profile& profile) {
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= along; ++j) {
        const double v = static_cast<double>(j) / along;
        const ProfilePoint point = profile(v);
        for (std::uint32_t i = 0; i <= kAround; ++i) {
            const double u = static_cast<double>(i) / kAround, c = std::cos(phi_max * u), s = std::sin(phi_max * u);
            mesh.positions.emplace_back(point.radius * c, point.radius * s, point.z);
            mesh.normals.emplace_back(point.normal_radius * c, point.normal_radius * s, point.normal_z);
            mesh.uvs.emplace_back(u, v);
        }
    }
    append_grid(mesh, 0, kAround, along);
    // Triangles at a pole have no area.
    std::erase_if(mesh.triangles, [&](const auto& t) {
        const auto& x = mesh.positions;
        return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).length2() == 0;
    });
    return mesh;
}

/// The sphere between two heights.
TriangleMesh revolve_arc(double radius, double low, double high, double phi_max) {
    const double bottom = std::acos(low / radius), top = std::acos(high / radius);
    return revolve(kAlong, phi_max, [&](double v) {
        const double theta = bottom + v * (top - bottom), s = std::max(0.0, std::sin(theta)), c = std::cos(theta);
        return ProfilePoint{radius * s, radius * c, s, c};
    });
}

double read_phi_max(Parameters& p) { return p.number("phimax", 360, {1e-3, 360}) * kPi / 180; }

} // namespace

Geometry read_sphere(Parameters& p) {
    const double radius = p.number("radius", 1, kPositive);
    const double a = p.number("zmin", -radius), b = p.number("zmax", radius);
    const double phi_max = read_phi_max(p);
    const double low = std::clamp(std::min(a, b), -radius, radius), high = std::clamp(std::max(a, b), -radius, radius);
    if (!(low < high))
        p.fail(fmt::format("found 'zmin' {} and 'zmax' {}, expected some of the sphere between them", a, b));
    if (low == -radius && high == radius && phi_max > 2 * kPi - 1e-9)
        return Sphere{Vec3(0.0f), static_cast<float>(radius), false};
    return revolve_arc(radius, low, high, phi_max);
}

TriangleMesh parametrised_sphere(double radius) { return revolve_arc(radius, -radius, radius, 2 * kPi); }

Geometry read_disk(Parameters& p) {
    const double radius = p.number("radius", 1, kPositive), inner = p.number("innerradius", 0, {0, 1e12});
    const double height = p.number("height", 0);
    const double phi_max = read_phi_max(p);
    if (!(inner < radius)) p.fail(fmt::format("found an inner radius of {}, expected one below {}", inner, radius));
    // v runs inwards, as in pbrt.
    return revolve(1, phi_max, [&](double v) { return ProfilePoint{radius + v * (inner - radius), height, 0, 1}; });
}

Geometry read_cylinder(Parameters& p) {
    const double radius = p.number("radius", 1, kPositive);
    const double a = p.number("zmin", -1), b = p.number("zmax", 1);
    const double phi_max = read_phi_max(p);
    if (a == b) p.fail("found 'zmin' equal to 'zmax', expected a height");
    return revolve(1, phi_max, [&](double v) {
        return ProfilePoint{radius, std::min(a, b) + v * std::abs(b - a), 1, 0};
    });
}

} // namespace keyhole::pbrt
