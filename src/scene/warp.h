// Maps from the unit square to directions and surfaces, with their densities stated.
#pragma once

#include "core/vec.h"

#include <algorithm>

namespace keyhole {

/// Unit vector with polar angle given by its cosine, around +z.
inline Vec3 spherical(double cos_theta, double phi) {
    const double sin_theta = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
    return {static_cast<float>(sin_theta * std::cos(phi)), static_cast<float>(sin_theta * std::sin(phi)),
            static_cast<float>(cos_theta)};
}

/// Density cos(theta) / pi per solid angle, around +z.
inline Vec3 cosine_hemisphere(double u0, double u1) { return spherical(std::sqrt(1 - u0), 2 * kPi * u1); }

/// Density 1 / (4 pi) per solid angle.
inline Vec3 uniform_sphere(double u0, double u1) { return spherical(1 - 2 * u0, 2 * kPi * u1); }

/// Uniform in the cone of half-angle acos(cos_max) around +z: density 1 / (2 pi (1 - cos_max)) per solid angle.
inline Vec3 uniform_cone(double u0, double u1, double cos_max) {
    return spherical(1 - u0 * (1 - cos_max), 2 * kPi * u1);
}

/// Uniform on the unit disc: density 1 / pi per area.
inline Vec2 uniform_disc(double u0, double u1) {
    const double r = std::sqrt(u0), phi = 2 * kPi * u1;
    return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi))};
}

/// Barycentric coordinates (of the second and third corner), uniform on a triangle.
inline Vec2 uniform_triangle(double u0, double u1) {
    const double s = std::sqrt(u0);
    return {static_cast<float>(s * (1 - u1)), static_cast<float>(s * u1)};
}

} // namespace keyhole
