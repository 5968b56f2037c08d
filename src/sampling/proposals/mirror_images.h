// The flat mirrors in which the eye sees things, and where it sees them: a point in a mirror's plane is reflected, and
// what the eye sees of the point lies on the straight line to its image.
#pragma once

#include "core/vec.h"
#include "scene/scene.h"

#include <array>
#include <optional>
#include <vector>

namespace keyhole {

/// Some of a plane that reflects as a mirror does: of one shape, with shading normals as the geometry has them.
struct FlatMirror {
    std::uint32_t shape;
    Imath::V3d normal; ///< unit
    double offset;     ///< of its points along `normal` [m]

    bool contains(const SurfacePoint& point) const;
    Imath::V3d reflect(const Imath::V3d& p) const { return p - normal * (2 * (p.dot(normal) - offset)); }
};

/// Immutable and thread-safe; the same for the same scene.
class MirrorImages {
  public:
    static constexpr int kMostMirrors = 3; ///< one after another, between the eye and what it sees
    static constexpr int kNone = -1;
    /// Mirrors by their index, in the order in which a ray from the eye meets them; kNone after the last.
    using Way = std::array<int, kMostMirrors>;

    /// Follows rays from the eye, and keeps the ways by mirrors that several of them take.
    explicit MirrorImages(const Scene& scene);

    bool empty() const { return ways_.empty(); }

    /// A way, with probability in proportion to what its mirrors reflect of all that the eye sees. Not empty().
    const Way& choose(double u) const;
    /// Probability of choose(); 0 for other ways.
    double probability(const Way& way) const;

    /// Index of the mirror that the point lies on; kNone where it lies on none of those kept.
    int find(const SurfacePoint& point) const;
    /// The point at which the eye sees `p` by way of mirrors.
    Imath::V3d image(const Way& way, const Imath::V3d& p) const;

  private:
    struct WeightedWay {
        Way way;
        double probability;
    };

    std::vector<FlatMirror> mirrors_;
    std::vector<WeightedWay> ways_;
};

} // namespace keyhole
