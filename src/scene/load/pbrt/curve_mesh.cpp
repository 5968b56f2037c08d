#include "scene/load/load_mesh.h"
#include "scene/load/pbrt/curves.h"

#include <Imath/ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyhole::pbrt {
namespace {

using Vec = Imath::V3d;

// A picture that shows the whole set has its facets within a pixel of 1000 across; one that shows a single curve,
// within some pixels.
constexpr double kShareOfSet = 1.0 / 1000, kShareOfCurve = 1.0 / 200;
constexpr double kLeastSides = 4, kMostSides = 32, kMostPieces = 64;
constexpr double kTwist = kPi / 12; // of a ribbon, from one piece to the next
constexpr double kCorner = 0.97;    // cosine of a turn between segments that is no bend but a corner

/// A cubic segment.
struct Segment {
    Vec p[4];

    Vec at(double u) const {
        const double w = 1 - u;
        return p[0] * (w * w * w) + p[1] * (3 * w * w * u) + p[2] * (3 * w * u * u) + p[3] * (u * u * u);
    }
    Vec derivative(double u) const {
        const double w = 1 - u;
        return (p[1] - p[0]) * (3 * w * w) + (p[2] - p[1]) * (6 * w * u) + (p[3] - p[2]) * (3 * u * u);
    }
    double polygon() const { return (p[1] - p[0]).length() + (p[2] - p[1]).length() + (p[3] - p[2]).length(); }
    /// Pieces of which each is within `tolerance` of its chord (Wang's bound: Goldman 2003, "Pyramid Algorithms"). What
    /// runs along the line between the ends bends nothing.
    double pieces(double tolerance) const {
        const Vec along = (p[3] - p[0]).normalized();
        double bend = 0;
        for (int i = 0; i < 2; ++i) {
            const Vec second = p[i] - p[i + 1] * 2 + p[i + 2];
            bend = std::max(bend, (second - along * along.dot(second)).length());
        }
        return std::ceil(std::sqrt(0.75 * bend / tolerance));
    }
};

/// How finely a curve is cut up.
struct Cut {
    std::uint32_t sides = 1; ///< around; 1: a ribbon
    double tolerance = 0;

    /// Corners of a ring.
    std::uint32_t corners() const { return sides == 1 ? 2 : sides; }
};

/// Turns from `a` to `b`, unit both.
Vec turned_normal(const Vec& a, const Vec& b, double share) {
    const double angle = std::acos(std::clamp(a.dot(b), -1.0, 1.0)), sine = std::sin(angle);
    if (sine < 1e-6) return a * (1 - share) + b * share;
    return a * (std::sin((1 - share) * angle) / sine) + b * (std::sin(share * angle) / sine);
}

/// A place on a curve.
struct CurvePoint {
    Vec position{0.0}, tangent{0.0}; ///< the latter unit
    Vec across{0.0};             ///< unit, perpendicular to the tangent: to a tube's first corner, or a ribbon's edge
    double u = 0;                ///< in its segment
    double width = 0, slope = 0; ///< the latter: how the radius grows along the curve
};

class CurveMesher {
  public:
    CurveMesher(const CurveSet& set, bool parametrised) : set_(set), parametrised_(parametrised) {
        Imath::Box3d box;
        for (const Vec3& p : set.points) box.extendBy(Vec(p));
        extent_ = box.size().length();
    }

    TriangleMesh make() {
        reserve();
        for_each_curve([this](const CurveSet::Curve& curve, const Cut& cut) { add(curve, cut); });
        return std::move(mesh_);
    }

  private:
    /// Calls `act` with each curve and its cut; meanwhile point_ and normal_ are those of its first segment.
    template <class Act> void for_each_curve(const Act& act) {
        point_ = normal_ = 0;
        for (const CurveSet::Curve& curve : set_.curves) {
            act(curve, cut_of(curve));
            point_ += 3 * curve.segments + 1;
            if (curve.is_ribbon) normal_ += curve.segments + 1;
        }
    }

    /// Of the curve at point_.
    Segment segment(std::uint32_t i) const {
        const Vec3* p = &set_.points[point_ + std::size_t{3} * i];
        return {{Vec(p[0]), Vec(p[1]), Vec(p[2]), Vec(p[3])}};
    }

    Cut cut_of(const CurveSet::Curve& curve) const {
        double length = 0;
        for (std::uint32_t i = 0; i < curve.segments; ++i) length += segment(i).polygon();
        Cut cut;
        cut.tolerance = std::max(std::min(kShareOfSet * extent_, kShareOfCurve * length), 1e-30);
        if (curve.is_ribbon) return cut;
        // A side of n is 1 - cos(pi / n) of the radius within the circle.
        const double radius = static_cast<double>(std::max(curve.width0, curve.width1)) / 2;
        const double sides = std::ceil(kPi * std::sqrt(radius / (2 * cut.tolerance)));
        cut.sides = static_cast<std::uint32_t>(std::clamp(sides, kLeastSides, kMostSides));
        return cut;
    }

    std::uint32_t pieces(const CurveSet::Curve& curve, const Cut& cut, std::uint32_t i) const {
        double n = segment(i).pieces(cut.tolerance);
        if (curve.is_ribbon) {
            const Vec3 *a = &set_.normals[normal_ + i], *b = a + 1;
            n = std::max(n, std::ceil(std::acos(std::clamp(static_cast<double>(a->dot(*b)), -1.0, 1.0)) / kTwist));
        }
        return static_cast<std::uint32_t>(std::clamp(n, 1.0, kMostPieces));
    }

    void reserve() {
        std::size_t rings = 0, triangles = 0, vertices = 0;
        for_each_curve([&](const CurveSet::Curve& curve, const Cut& cut) {
            rings = parametrised_ ? curve.segments : 1;
            for (std::uint32_t i = 0; i < curve.segments; ++i) {
                rings += pieces(curve, cut, i);
                triangles += std::size_t{2} * cut.sides * pieces(curve, cut, i);
            }
            vertices += rings * cut.corners();
        });
        if (triangles > kMaxMeshTriangles)
            throw InputError(
                fmt::format("found curves of {} triangles, expected at most {}", triangles, kMaxMeshTriangles));
        mesh_.positions.reserve(vertices);
        mesh_.normals.reserve(vertices);
        if (parametrised_) mesh_.uvs.reserve(vertices);
        mesh_.triangles.reserve(triangles);
    }

    void add(const CurveSet::Curve& curve, const Cut& cut) {
        CurvePoint last;
        for (std::uint32_t i = 0; i < curve.segments; ++i) {
            const Segment s = segment(i);
            if (!(s.polygon() > 0)) continue;
            const std::uint32_t n = pieces(curve, cut, i);
            for (std::uint32_t k = 0; k <= n; ++k) {
                const CurvePoint point = place(curve, s, i, static_cast<double>(k) / n, last);
                const bool joins = k == 0 && !parametrised_ && last.tangent.dot(point.tangent) > kCorner;
                if (!joins) add_ring(point, cut);
                if (k > 0) connect(last.width > 0, point.width > 0, cut);
                last = point;
            }
        }
    }

    /// `last` is the point before; its tangent is 0 where there is none.
    CurvePoint place(const CurveSet::Curve& curve, const Segment& s, std::uint32_t i, double u,
                     const CurvePoint& last) const {
        const double width0 = static_cast<double>(curve.width0), width1 = static_cast<double>(curve.width1);
        CurvePoint point;
        point.position = s.at(u);
        point.u = u;
        point.width = width0 + (width1 - width0) * (i + u) / curve.segments;
        // Points may coincide at the ends; the tangent there is that beside them.
        Vec along = s.derivative(u);
        if (!(along.length() > 1e-6 * s.polygon())) along = s.derivative(0.5 + (u - 0.5) * 0.99);
        point.tangent = along.length() > 0 ? along.normalized() : (s.p[3] - s.p[0]).normalized();
        point.slope = along.length() > 0 ? (width1 - width0) / (2 * curve.segments * along.length()) : 0;
        point.across = last.across;
        if (curve.is_ribbon) {
            const Vec3* n = &set_.normals[normal_ + i];
            const Vec across = turned_normal(Vec(n[0]), Vec(n[1]), u).cross(point.tangent);
            if (across.length() > 1e-3) point.across = across;
        }
        // As little twist as there may be from ring to ring.
        point.across -= point.tangent * point.tangent.dot(point.across);
        if (!(point.across.length() > 1e-3)) point.across = Vec(Frame(Vec3(point.tangent)).s);
        point.across.normalize();
        return point;
    }

    void add_ring(const CurvePoint& point, const Cut& cut) {
        const Vec up = point.tangent.cross(point.across);
        if (cut.sides == 1) {
            for (const double side : {0.5, -0.5}) add_corner(point.position + point.across * (side * point.width), up);
            if (parametrised_) mesh_.uvs.insert(mesh_.uvs.end(), {Vec2(point.u, 1), Vec2(point.u, 0)});
            return;
        }
        const double radius = point.width / 2 * (kPi / cut.sides) / std::sin(kPi / cut.sides);
        for (std::uint32_t k = 0; k < cut.sides; ++k) {
            const double turn = static_cast<double>(k) / cut.sides;
            const Vec out = point.across * std::cos(2 * kPi * turn) + up * std::sin(2 * kPi * turn);
            add_corner(point.position + out * radius, (out - point.tangent * point.slope).normalized());
            if (parametrised_) mesh_.uvs.emplace_back(point.u, 1 - std::abs(1 - 2 * turn));
        }
    }

    void add_corner(const Vec& position, const Vec& normal) {
        mesh_.positions.emplace_back(position);
        mesh_.normals.emplace_back(normal);
    }

    /// Between the last two rings; where one is a point, triangles with a side on it have no area.
    void connect(bool is_wide0, bool is_wide1, const Cut& cut) {
        const auto b = static_cast<std::uint32_t>(mesh_.positions.size()) - cut.corners(), a = b - cut.corners();
        for (std::uint32_t k = 0; k < cut.sides; ++k) {
            const std::uint32_t next = (k + 1) % cut.corners();
            if (is_wide0) mesh_.triangles.push_back({a + k, a + next, b + k});
            if (is_wide1) mesh_.triangles.push_back({a + next, b + next, b + k});
        }
    }

    const CurveSet& set_;
    bool parametrised_;
    double extent_ = 0; // [m], the diagonal of the box around all points
    std::size_t point_ = 0, normal_ = 0;
    TriangleMesh mesh_;
};

} // namespace

TriangleMesh mesh_of_curves(const CurveSet& set, bool parametrised) {
    TriangleMesh mesh = CurveMesher(set, parametrised).make();
    mend_mesh(mesh, "curve");
    return mesh;
}

} // namespace keyhole::pbrt
