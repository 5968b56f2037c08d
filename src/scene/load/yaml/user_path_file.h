// Files of user paths. Their format is described in docs/user-paths.md.
#pragma once

#include "core/error.h"
#include "core/vec.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keyhole {

/// A parallelogram in the air, world space [m].
struct Opening {
    Imath::V3d corner, u, v; ///< a corner, and the edges that leave it

    Imath::V3d centre() const { return corner + (u + v) / 2; }
};

/// A point of a user path as it is given.
struct UserPathPoint {
    Imath::V3d p{0, 0, 0}; ///< world space [m]
    FilePosition where{};
    std::optional<Opening> through{}; ///< what the segment towards the point passes
    bool bounce = false;              ///< no point: light is scattered anywhere. An opening follows the last of several
};

/// A user path as it is given.
struct UserPathSpec {
    std::string name;
    double weight = 1;
    std::vector<UserPathPoint> points; ///< from the light on; at least two
    std::vector<double> beta;          ///< half-angle of the cone of each segment [rad]; one fewer than points. Of no
                                       ///< meaning for segments through an opening
    std::optional<double> patch; ///< radius of the part of the emitter that candidates begin on [m]; none: all of it
    std::optional<double> tolerance; ///< how far a point may be from its surface [m]
    FilePosition where{};
};

struct UserPathFile {
    std::vector<UserPathSpec> paths;
};

/// An entry of a file: a path, or one for each of several numbers of bounces.
struct UserPathEntry {
    std::string name;
    double weight = 0;                               ///< of all its paths
    std::span<const UserPathSpec> paths;             ///< at least one, each with one bounce more than the one before
    std::size_t least_bounces = 0, most_bounces = 0; ///< of the first and the last
};

/// The entries that the paths of a file come from, in their order; they refer to it.
std::vector<UserPathEntry> entries_of(const UserPathFile& file);

/// Half-angle where a file gives none [rad].
constexpr double kDefaultBeta = 5 * kPi / 180;
/// How the weights of an entry's paths fall from one number of bounces to the next, as the light grows weaker.
constexpr double kNextBounce = 0.85;
/// Most points of a path; more are taken for a mistake in the file.
constexpr std::size_t kMostUserPoints = 31;

/// Reads a file of user paths; there is at least one. An entry for several numbers of bounces becomes a path for each.
/// @throws InputError "file:line:column: what was found, what was expected" for every mistake in the file.
UserPathFile load_user_paths(const std::string& path);

/// The text of a file that load_user_paths() reads as `file`, after `comment` (lines without their '#').
std::string user_paths_text(const UserPathFile& file, const std::string& comment);

} // namespace keyhole
