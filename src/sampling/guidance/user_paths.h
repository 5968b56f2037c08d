// Paths that a person gives to guide the chains: from a light to a surface, along which light goes that is hard to
// find.
#pragma once

#include "core/rng.h"
#include "core/vec.h"
#include "sampling/paths/path.h"
#include "scene/load/yaml/user_path_file.h"
#include "scene/scene.h"
#include "scene/warp.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace keyhole {

/// An opening that light has to pass: a parallelogram in the air. Directions towards it are drawn nearly uniform by
/// solid angle, in longitude and latitude about its longer edge: a density by its area would be far too low for what
/// lies close to a long slit.
class Portal {
  public:
    /// `corner`, and the edges `u` and `v` that leave it, not parallel; world space [m].
    Portal(const Imath::V3d& corner, const Imath::V3d& u, const Imath::V3d& v) : corner_(corner) {
        const auto& [longer, shorter] = u.length2() >= v.length2() ? std::pair(u, v) : std::pair(v, u);
        length_ = longer.length();
        axis_ = longer / length_;
        normal_ = axis_.cross(shorter).normalized();
        across_ = normal_.cross(axis_);
        along_edge_ = shorter.dot(axis_);
        width_ = shorter.dot(across_);
    }

    /// Unit direction from `from` through the opening.
    Vec3 sample(const Vec3& from, SampleSource& source) const {
        const double u0 = source.next(), u1 = source.next();
        const View view(*this, from);
        const double phi = std::lerp(view.least, view.most, u0);
        const auto [low, high] = view.latitudes(std::tan(phi));
        const double t = std::lerp(low, high, u1), r = std::sqrt(std::max(0.0, 1 - t * t));
        return Vec3((axis_ * t + across_ * (r * std::sin(phi)) + normal_ * std::copysign(r * std::cos(phi), view.up))
                        .normalized());
    }
    /// Density of sample() per solid angle; 0 where `w` misses the opening, and so near to its plane that rounding
    /// would decide: walls beside a door lie in it.
    double density(const Vec3& from, const Vec3& w) const {
        const View view(*this, from);
        const Imath::V3d d(w);
        const double t = d.dot(axis_), side = d.dot(across_), up = d.dot(normal_);
        if (in_plane(view.up) || !(up * view.up > 0)) return 0;
        const double phi = std::atan2(side, std::abs(up));
        if (!(phi >= view.least && phi <= view.most)) return 0;
        const auto [low, high] = view.latitudes(side / std::abs(up));
        if (!(t >= low && t <= high)) return 0;
        return 1 / ((view.most - view.least) * (high - low));
    }

    /// A line through the opening.
    struct Line {
        Vec3 p; ///< where it crosses
        Vec3 w; ///< unit
    };
    /// Uniform by area and projected solid angle: lines as light that comes evenly from everywhere has them.
    /// `side`: of the opening, where they begin.
    Line sample_line(const Vec3& side, SampleSource& source) const {
        const double across = source.next(), along = source.next();
        const Imath::V3d p = corner_ + across_ * (across * width_) + axis_ * (across * along_edge_ + along * length_);
        const double u0 = source.next(), u1 = source.next();
        const Frame frame(Vec3(normal_ * std::copysign(1.0, height(side))));
        return {Vec3(p), frame.to_world(cosine_hemisphere(u0, u1))};
    }
    /// Density of sample_line() for the one from b to c, per area and projected solid angle [1/(m^2 sr)]. Multiplied by
    /// the geometry term of b and c it is the connection density of the two, per area at each [1/m^4]. 0 where the
    /// opening is not between them, or b not on the side of `side`.
    double line_density(const Vec3& side, const Vec3& b, const Vec3& c) const {
        if (!(height(side) * height(b) > 0 && separates(b, c))) return 0;
        return density(b, (c - b).normalized()) > 0 ? 1 / (kPi * length_ * width_) : 0.0;
    }

    /// Whether two places lie on different sides of its plane.
    bool separates(const Vec3& b, const Vec3& c) const {
        return height(b) * height(c) < 0 && !in_plane(height(b)) && !in_plane(height(c));
    }

  private:
    /// From a place to the opening's plane, along its normal [m].
    double height(const Vec3& from) const { return (corner_ - Imath::V3d(from)).dot(normal_); }
    /// So near that rounding would decide.
    bool in_plane(double height) const { return !(std::abs(height) > 1e-5 * length_); }

    /// The opening from where it is seen, in the frame of its axis.
    struct View {
        const Portal& portal;
        double along, beside, up; ///< from there to the corner
        double least, most;       ///< longitude [rad]

        View(const Portal& p, const Vec3& from) : portal(p) {
            const Imath::V3d r = p.corner_ - Imath::V3d(from);
            along = r.dot(p.axis_);
            beside = r.dot(p.across_);
            up = r.dot(p.normal_);
            least = std::atan2(beside, std::abs(up));
            most = std::atan2(beside + p.width_, std::abs(up));
        }
        /// Sines of the latitudes between which the opening is seen at a longitude.
        std::pair<double, double> latitudes(double tangent) const {
            const double s = tangent * std::abs(up), start = along + (s - beside) / portal.width_ * portal.along_edge_;
            const auto sine = [&](double x) { return x / std::sqrt(x * x + s * s + up * up); };
            return {sine(start), sine(start + portal.length_)};
        }
    };

    Imath::V3d corner_, axis_, across_, normal_; // unit but for the corner
    double length_, width_, along_edge_;         // of the longer edge; of the other, across it and along it
};

/// The surroundings of a point on an emitter, or all of it. Within a radius: on a mesh the triangle that the point lies
/// in, shrunk towards it; on a sphere a cap. Of a light in a point that point. A density is so known everywhere without
/// tracing a ray. The scene must outlive it.
class EmitterPatch {
  public:
    /// @param center a point on an emitter that is not infinite, as rays find or emitters sample it.
    /// @param radius no point of the patch lies farther from the centre, along the surface [m]; none: the whole emitter
    EmitterPatch(const Scene& scene, const SurfacePoint& center, std::optional<double> radius = std::nullopt);

    const SurfacePoint& center() const { return center_; }
    /// Uniform by area.
    SurfacePoint sample(SampleSource& source) const;
    /// Density of sample() [1/m^2], 1 for a light in a point; 0 for points elsewhere.
    double pdf(const SurfacePoint& point) const;

  private:
    bool is_whole() const { return whole_ || center_.site != Site::surface; }
    Vec2 barycentric(const Vec3& p) const;

    const Scene* scene_;
    SurfacePoint center_;
    bool whole_;
    Vec2 center_barycentric_{0, 0};
    double scale_ = 1;   ///< of the triangle
    double cosine_ = -1; ///< of half the cap's angle
    double area_ = 1;
};

/// A vertex of a user path after the light.
struct UserVertex {
    Vec3 p;      ///< on its surface, world space; of no meaning for a bounce
    Event event; ///< how light goes on here
    double beta; ///< half-angle of the cone in which the segment towards this vertex may lie [rad]; of no meaning if
                 ///< the vertex before it is specular
    std::optional<Portal> portal{}; ///< what that segment passes, in place of the cone
    bool bounce = false;            ///< anywhere: light comes here as it is emitted or scattered
};

/// A user path whose points were found in a scene.
struct UserPath {
    std::string name;
    double weight;                    ///< relative frequency among user paths
    EmitterPatch patch;               ///< where candidates begin
    std::vector<UserVertex> vertices; ///< x1, ..., xk; the last one is not specular
    bool seen;                        ///< whether the eye sees the last vertex, so that it may be joined to the eye

    /// Events in order from the light, as in "L S S D"; "*" for a bounce.
    std::string signature() const;
};

using UserPaths = std::vector<UserPath>;

/// Finds the points of a path in the scene: each at the first surface that light meets on its way from the point
/// before it, behind bounces from the middle of the opening, or where a specular vertex sends it.
/// @throws InputError that names file, path and point: for a segment that is blocked, a point in the air or off the way
/// that a mirror or glass gives the light, an emitter that sends no light this way, a surface that scatters none, a
/// last vertex that is specular.
UserPath bind_user_path(const Scene& scene, const UserPathSpec& spec);

/// Whether it can be bound.
bool binds(const Scene& scene, const UserPathSpec& spec);

/// All paths of a file. @throws InputError as bind_user_path().
UserPaths bind_user_paths(const Scene& scene, const UserPathFile& file);

/// The paths that bind_user_path() takes. @param warnings receives why it refuses the others, one line each
UserPathFile usable_paths(const Scene& scene, UserPathFile file, std::vector<std::string>& warnings);

} // namespace keyhole
