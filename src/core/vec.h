// Vectors, colours and frames: Imath's, under the names that the rest of the code uses.
#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace keyhole {

using Vec2 = Imath::V2f;
using Vec3 = Imath::V3f;

/// Linear Rec. 709 triple. Double, because contributions of long paths span hundreds of decades.
using Rgb = Imath::Color3<double>;

constexpr double kPi = std::numbers::pi;
constexpr double kInvPi = std::numbers::inv_pi;

/// Luminance Y of linear Rec. 709 primaries.
inline double luminance(const Rgb& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

inline bool is_black(const Rgb& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

inline bool is_finite(const Rgb& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

/// Sizes of the coordinates.
template <class T> Imath::Vec3<T> absolute(const Imath::Vec3<T>& v) {
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

/// The normal `n` or its opposite: the one on the side that `w` points to.
inline Vec3 facing(const Vec3& n, const Vec3& w) { return n.dot(w) < 0 ? -n : n; }

/// Right-handed orthonormal frame around a unit normal.
struct Frame {
    Vec3 s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

    Frame() = default;

    /// Any frame with third axis `normal` (unit). Duff et al. 2017, continuous but at n.z = -1.
    explicit Frame(const Vec3& normal) : n(normal) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        t = {b, sign + n.y * n.y * a, -n.y};
    }

    Vec3 to_local(const Vec3& v) const { return {v.dot(s), v.dot(t), v.dot(n)}; }
    Vec3 to_world(const Vec3& v) const { return s * v.x + t * v.y + n * v.z; }
};

/// The direction of the six along the axes that is nearest to `n`, of any length: x, y, z, -x, -y, -z.
inline std::size_t facet_of(const Vec3& n) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(n[i]) > std::abs(n[axis])) axis = i;
    return static_cast<std::size_t>(n[axis] < 0 ? axis + 3 : axis);
}

} // namespace keyhole
