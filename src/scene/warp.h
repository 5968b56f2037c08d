// Maps from the unit square to directions and surfaces, with their densities stated.
#pragma once

#include "core/vec.h"

#include <algorithm>

namespace keyhole {

/// Cosine and sine of `turns` full turns, for 0 <= turns <= 1; within 1e-11. A third of the cost of std::sin() and
/// std::cos(), which must first find out where in its turn an angle is. Polynomials: least squares of the relative
/// error.
struct CirclePoint {
    double x, y;
};
inline CirclePoint circle_point(double turns) {
    const double quarter = std::floor(4 * turns + 0.5), r = 4 * turns - quarter, z = r * r; // |r| <= 1/2
    const double c = 0.9999999999999339 +
                     z * (-1.2337005501181455 +
                          z * (0.25366950709029124 + z * (-0.020863467299763683 +
                                                          z * (0.0009191585522689907 + z * -2.4845901139796366e-05))));
    const double s = r * (1.5707963267877394 +
                          z * (-0.6459640961014678 +
                               z * (0.0796925818244058 + z * (-0.004681260511306618 + z * 0.00015819484452518108))));
    // Quarters are as good as random: what has no branches can't be predicted wrongly.
    const auto q = static_cast<unsigned>(quarter) % 4;
    constexpr double x_sign[] = {1, -1, -1, 1}, y_sign[] = {1, 1, -1, -1};
    return {x_sign[q] * (q % 2 == 0 ? c : s), y_sign[q] * (q % 2 == 0 ? s : c)};
}

/// Unit vector with polar angle given by its cosine, around +z.
inline Vec3 spherical(double cos_theta, double phi) {
    const double sin_theta = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
    return {static_cast<float>(sin_theta * std::cos(phi)), static_cast<float>(sin_theta * std::sin(phi)),
            static_cast<float>(cos_theta)};
}

/// Density cos(theta) / pi per solid angle, around +z.
inline Vec3 cosine_hemisphere(double u0, double u1) {
    const double r = std::sqrt(u0);
    const auto [c, s] = circle_point(u1);
    return {static_cast<float>(r * c), static_cast<float>(r * s), static_cast<float>(std::sqrt(1 - u0))};
}

/// Density 1 / (4 pi) per solid angle.
inline Vec3 uniform_sphere(double u0, double u1) { return spherical(1 - 2 * u0, 2 * kPi * u1); }

/// Uniform in the cone of half-angle acos(cos_max) around +z: density 1 / (2 pi (1 - cos_max)) per solid angle.
inline Vec3 uniform_cone(double u0, double u1, double cos_max) {
    return spherical(1 - u0 * (1 - cos_max), 2 * kPi * u1);
}

/// Whether unit `w` lies in the cone around unit `axis`. By the chord: the cosine of a small angle has no digits left
/// in floats, and of the directions that uniform_cone() draws some would lie outside.
inline bool in_cone(const Vec3& w, const Vec3& axis, double cos_max) {
    return Imath::V3d(w - axis).length2() <= 2 * (1 - cos_max);
}

/// Uniform on the unit disc: density 1 / pi per area.
inline Vec2 uniform_disc(double u0, double u1) {
    const double r = std::sqrt(u0);
    const auto [c, s] = circle_point(u1);
    return {static_cast<float>(r * c), static_cast<float>(r * s)};
}

/// Barycentric coordinates (of the second and third corner), uniform on a triangle.
inline Vec2 uniform_triangle(double u0, double u1) {
    const double s = std::sqrt(u0);
    return {static_cast<float>(s * (1 - u1)), static_cast<float>(s * u1)};
}

} // namespace keyhole
