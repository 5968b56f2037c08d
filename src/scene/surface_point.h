// A point that a path may have as a vertex: on a surface, a point in space, or infinitely far away.
#pragma once

#include "core/vec.h"

#include <cstdint>

namespace keyhole {

class Material;

/// What kind of place a SurfacePoint is; it decides which factors a geometry term has.
enum class Site : std::uint8_t {
    surface,  ///< on geometry: cosine and area measure
    point,    ///< a point in space (pinhole, point light): no cosine
    medium,   ///< a point where a medium scatters: no cosine, and volume measure
    infinite, ///< a direction (environment, distant light): `ng` points from there to the scene
};

/// A place in world space with what scattering and emission need to know of it. Plain value.
struct SurfacePoint {
    static constexpr std::uint32_t kNone = ~0u;

    Vec3 p{0, 0, 0};       ///< world position; the unit direction towards an infinite point
    Vec3 ng{0, 0, 0};      ///< unit geometric normal; its side is the shape's outside
    Vec3 ns{0, 0, 0};      ///< unit shading normal, in the hemisphere of ng
    Vec3 tangent{0, 0, 0}; ///< unit, perpendicular to ns, along increasing u where there is a parametrisation; 0: none
    Vec2 uv{0, 0};         ///< texture coordinates
    float dpdu = 1;        ///< length of dp/du in the tangent plane, along `tangent` [m]
    Vec2 dpdv{0, 1};       ///< dp/dv in the tangent plane, along `tangent` and ns x tangent [m]
    float offset = 0;      ///< bound on the error of p along ng; ray origins move by this much. Of a point in
                           ///< space: how far from it rays start
    Site site = Site::surface;
    std::uint32_t shape = kNone;     ///< index of the shape in the scene
    std::uint32_t primitive = kNone; ///< triangle within the shape
    std::uint32_t emitter = kNone;   ///< index of the emitter that this point belongs to
    const Material* material = nullptr;

    /// The frame of ns whose first axis is the tangent, or any where there is none.
    Frame shading_frame() const {
        if (tangent == Vec3(0, 0, 0) || !(std::abs(tangent.dot(ns)) < 1e-3f)) return Frame(ns);
        Frame frame;
        frame.n = ns;
        frame.t = ns.cross(tangent).normalized();
        frame.s = frame.t.cross(ns);
        return frame;
    }

    bool is_emitter() const { return emitter != kNone; }

    /// |cos| between the geometric normal and a unit direction; 1 where the site has no surface.
    double abs_cos(const Vec3& w) const {
        return site == Site::surface ? std::abs(static_cast<double>(ng.dot(w))) : 1.0;
    }

    /// Where a ray that leaves this point along `w` may start without meeting its own surface.
    Vec3 ray_origin(const Vec3& w) const {
        if (site == Site::surface) return p + ng * (w.dot(ng) < 0 ? -offset : offset);
        return site == Site::point && offset > 0 ? p + w * offset : p;
    }
};

/// The infinite point that lies in the unit direction `towards`.
inline SurfacePoint infinite_point(const Vec3& towards) {
    SurfacePoint s;
    s.p = towards;
    s.ng = s.ns = -towards;
    s.site = Site::infinite;
    return s;
}

/// Unit direction from `a` towards `b`. At least one of the two is not infinite.
inline Vec3 direction(const SurfacePoint& a, const SurfacePoint& b) {
    if (b.site == Site::infinite) return -b.ng;
    if (a.site == Site::infinite) return a.ng;
    return (b.p - a.p).normalized();
}

/// Geometry term G(a,b) of an edge without its visibility: cos cos / r^2 [1/m^2], with the factors left out that a
/// point or an infinite end doesn't have. 0 for coinciding points. `w` is the direction between the two, either way.
inline double geometry_term(const SurfacePoint& a, const SurfacePoint& b, const Vec3& w) {
    const double cosines = a.abs_cos(w) * b.abs_cos(w);
    if (a.site == Site::infinite || b.site == Site::infinite) return cosines;
    const double r2 = Imath::V3d(b.p - a.p).length2();
    return r2 > 0 ? cosines / r2 : 0.0;
}
inline double geometry_term(const SurfacePoint& a, const SurfacePoint& b) {
    return geometry_term(a, b, direction(a, b));
}

/// Turns a density per solid angle at `from`, in the direction of `to`, into one in the coordinates of `to`: area on a
/// surface; solid angle stays for an infinite point. From an infinite point the density is one over the area of its
/// beam. `w` is the direction between the two, either way: most of the cost is in finding it.
inline double solid_angle_to_area(double pdf, const SurfacePoint& from, const SurfacePoint& to, const Vec3& w) {
    if (to.site == Site::infinite) return pdf;
    const double c = to.abs_cos(w);
    if (from.site == Site::infinite) return pdf * c;
    const double r2 = Imath::V3d(to.p - from.p).length2();
    return r2 > 0 ? pdf * c / r2 : 0.0;
}
inline double solid_angle_to_area(double pdf, const SurfacePoint& from, const SurfacePoint& to) {
    return solid_angle_to_area(pdf, from, to, direction(from, to));
}

} // namespace keyhole
