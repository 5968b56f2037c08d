// Small places that are much brighter than what is around them, for gather rays to aim at.
#pragma once

#include "core/progress.h"
#include "gather/gather_rays.h"

#include <cstdint>
#include <span>
#include <vector>

namespace keyhole {

/// The directions from some point in which a spot may lie.
struct SpotCone {
    int spot;
    Vec3 axis; ///< unit
    double cos_half_angle;
    int rays; ///< to be spent on it

    double solid_angle() const { return 2 * kPi * (1 - cos_half_angle); }
};

/// Cells of an octree from which gather rays brought far more than their share, found by thousands of rays from what
/// the eye sees. A cell is as small as the findings in it can tell: a lampshade behind slits, of which few rays see
/// anything, is one cell; the patch of sun that many see is several. Only where rays go depends on them, so that a spot
/// which was missed costs noise, and no light. Immutable and thread-safe.
class HotSpots {
  public:
    /// None.
    HotSpots() = default;
    /// Looks for them with `count` rays.
    HotSpots(const GatherRays& rays, std::int64_t count, std::uint64_t seed, const RunContext& context);

    /// The spot that a place belongs to; -1: none.
    int spot_at(const Vec3& place) const;

    /// Cones of the spots that are worth aiming at from `p` with normal `n`, and at most `rays` rays shared among them
    /// by what they may bring: fewer where spots are the lesser part of what makes rays differ. Spots that surround `p`
    /// are left out.
    std::vector<SpotCone> cones_from(const Vec3& p, const Vec3& n, int rays) const;

    std::size_t size() const { return spots_.size(); }

  private:
    /// What one ray brought, and from where.
    struct Finding {
        Vec3 place{0, 0, 0};
        double radiance = -1; ///< luminance; negative: nothing was met
    };
    struct Cell {
        Vec3 centre;
        float width; ///< [m]

        std::size_t octant(const Vec3& place) const;
        Cell child(std::size_t octant) const;
    };
    /// Children of a node follow each other from `children` on; a leaf has none (-1), but may be a spot.
    struct Node {
        int children = -1, spot = -1;
    };
    /// What lies in a leaf's cell and in a ball.
    struct Spot {
        Vec3 centre;
        float radius;    ///< [m]
        double radiance; ///< root of the mean square of what rays brought from there [W/(m^2 sr)]
        double share;    ///< of the second moment of what rays bring
    };
    static Finding find(const GatherRays& rays, std::uint64_t seed, std::int64_t i);
    /// Moments of what all rays brought.
    struct Whole {
        double sum2 = 0, rays = 0;
    };
    static Spot spot_of(const Cell& cell, std::span<const Finding> findings, double sum2, double effective,
                        double share);
    void divide(std::size_t node, const Cell& cell, std::span<Finding> findings, const Whole& whole, int depth);
    void keep_the_brightest();

    Cell root_{Vec3(0), 0};
    std::vector<Node> nodes_;
    std::vector<Spot> spots_;
    double share_ = 0; ///< that all spots have of the second moment
};

} // namespace keyhole
