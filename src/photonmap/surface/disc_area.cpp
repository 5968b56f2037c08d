#include "photonmap/surface/disc_area.h"

#include "core/vec.h"

#include <algorithm>

namespace keyhole {
namespace {

using Imath::V2d;

/// Signed area of the sector between the directions of u and v.
double sector(const V2d& u, const V2d& v, double r2) { return std::atan2(u.cross(v), u.dot(v)) * r2 / 2; }

/// Signed area that the disc has in common with the triangle (origin, a, b): a triangle where the edge runs inside,
/// sectors where it runs outside.
double edge_area(const V2d& a, const V2d& b, double r2) {
    const V2d d = b - a;
    const double dd = d.length2(), ad = a.dot(d);
    const double discriminant = ad * ad - dd * (a.length2() - r2);
    if (discriminant <= 0) return sector(a, b, r2);
    const double root = std::sqrt(discriminant);
    const double enter = (-ad - root) / dd, leave = (-ad + root) / dd;
    if (enter >= 1 || leave <= 0) return sector(a, b, r2);
    double area = 0;
    V2d p = a, q = b;
    if (enter > 0) {
        p = a + d * enter;
        area += sector(a, p, r2);
    }
    if (leave < 1) {
        q = a + d * leave;
        area += sector(q, b, r2);
    }
    return area + p.cross(q) / 2;
}

/// Whether the disc lies on the left of edge ab (on the right for orientation -1).
bool disc_inside(const V2d& a, const V2d& b, double orientation, double r2) {
    const double twice = a.cross(b) * orientation;
    return twice >= 0 && twice * twice >= r2 * (b - a).length2();
}

} // namespace

double disc_triangle_area(const V2d& a, const V2d& b, const V2d& c, double r) {
    const double r2 = r * r;
    const double twice = (b - a).cross(c - a);
    // The two common cases of big and small triangles need no angles.
    const double orientation = twice < 0 ? -1 : 1;
    if (disc_inside(a, b, orientation, r2) && disc_inside(b, c, orientation, r2) && disc_inside(c, a, orientation, r2))
        return kPi * r2;
    if (std::max({a.length2(), b.length2(), c.length2()}) <= r2) return std::abs(twice) / 2;
    return std::abs(edge_area(a, b, r2) + edge_area(b, c, r2) + edge_area(c, a, r2));
}

} // namespace keyhole
