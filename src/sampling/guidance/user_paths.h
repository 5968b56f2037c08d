// Paths that a person gives to guide the chains: from a light to a surface, along which light goes that is hard to
// find.
#pragma once

#include "core/rng.h"
#include "sampling/guidance/portal.h"
#include "sampling/paths/path.h"
#include "scene/load/yaml/user_path_file.h"
#include "scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace keyhole {

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
