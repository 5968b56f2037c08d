// Paths that a person gives to guide the chains: from a light to a surface, along which light goes that is hard to
// find.
#pragma once

#include "sampling/emitter_patch.h"
#include "sampling/path.h"
#include "sampling/portal.h"
#include "scene/load/user_path_file.h"

#include <optional>
#include <string>
#include <vector>

namespace keyhole {

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

/// All paths of a file. @throws InputError as bind_user_path().
UserPaths bind_user_paths(const Scene& scene, const UserPathFile& file);

} // namespace keyhole
