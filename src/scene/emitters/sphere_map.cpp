#include "scene/emitters/sphere_map.h"

#include <algorithm>

namespace keyhole {
namespace {

Vec3 to_vec3(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

Vec3 lat_long_direction(const Vec2d& place) {
    const double theta = kPi * place.y, phi = 2 * kPi * (place.x - 0.5);
    return to_vec3(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
}

Vec2d lat_long_place(const Vec3& w) {
    const double phi = std::atan2(static_cast<double>(w.x), -static_cast<double>(w.z));
    return {0.5 + phi / (2 * kPi), std::acos(std::clamp(static_cast<double>(w.y), -1.0, 1.0)) / kPi};
}

/// Each octant of the sphere is a triangle of the square [-1,1]^2: lines |x| + |y| = r of its inner half are circles at
/// z = 1 - r^2, which encloses solid angle in proportion to the square's area; azimuth runs evenly along them. The
/// outer half is the mirror image of the inner one at |x| + |y| = 1 and holds the lower hemisphere.
Vec3 octahedral_direction(const Vec2d& place) {
    const double x = 2 * place.x - 1, y = 2 * place.y - 1;
    const double a = std::abs(x), b = std::abs(y), inside = 1 - a - b;
    const double r = 1 - std::abs(inside);
    const double phi = r > 0 ? ((b - a) / r + 1) * kPi / 4 : 0;
    const double s = r * std::sqrt(std::max(0.0, 2 - r * r)), z = 1 - r * r;
    return to_vec3(std::copysign(s * std::cos(phi), x), std::copysign(s * std::sin(phi), y), inside < 0 ? -z : z);
}

Vec2d octahedral_place(const Vec3& w) {
    const double x = w.x, y = w.y, z = w.z;
    const double r = std::sqrt(std::max(0.0, 1 - std::abs(z)));
    const double phi = std::atan2(std::abs(y), std::abs(x)) * 2 / kPi; // in [0,1]
    double a = r * (1 - phi), b = r * phi;
    if (z < 0) {
        const double swapped = 1 - a;
        a = 1 - b;
        b = swapped;
    }
    return {(std::copysign(a, x) + 1) / 2, (std::copysign(b, y) + 1) / 2};
}

} // namespace

Vec3 sphere_direction(SphereLayout layout, const Vec2d& place) {
    return layout == SphereLayout::octahedral ? octahedral_direction(place) : lat_long_direction(place);
}

Vec2d sphere_place(SphereLayout layout, const Vec3& w) {
    return layout == SphereLayout::octahedral ? octahedral_place(w) : lat_long_place(w);
}

} // namespace keyhole
