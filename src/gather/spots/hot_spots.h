// Small places that are much brighter than what is around them, for gather rays to aim at.
#pragma once

#include "core/progress.h"
#include "gather/gather_rays.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace keyhole {

/// The directions from some point in which a spot may lie.
struct SpotCone {
    int spot;
    Vec3 axis; ///< unit
    double cos_half_angle;
    double irradiance; ///< about what comes from there [W/m^2]
    int rays = 0;      ///< to be spent on it

    double solid_angle() const { return 2 * kPi * (1 - cos_half_angle); }
};

/// Balls from which gather rays brought far more than their share, found by thousands of rays from what the eye sees.
/// Only where rays go depends on them, so that a spot which was missed costs noise, and no light. Immutable and
/// thread-safe.
class HotSpots {
  public:
    static constexpr std::size_t kMost = 64; ///< spots

    /// None.
    HotSpots() = default;
    /// Looks for them with `count` rays.
    HotSpots(const GatherRays& rays, std::int64_t count, std::uint64_t seed, const RunContext& context);

    /// Whether a place lies in the ball of a spot.
    bool contains(int spot, const Vec3& place) const {
        const Spot& s = spots_[static_cast<std::size_t>(spot)];
        return (place - s.centre).length2() <= s.radius * s.radius;
    }

    /// Calls visit(cone) for the spots that shine on `p` with normal `n`, if they see it. Spots that surround `p` are
    /// left out.
    template <class Visit> void for_each_cone(const Vec3& p, const Vec3& n, Visit&& visit) const {
        for (std::size_t i = 0; i < spots_.size(); ++i)
            if (const auto cone = cone_of(i, p, n)) visit(*cone);
    }
    std::vector<SpotCone> cones_from(const Vec3& p, const Vec3& n) const;
    /// Those that are worth rays, and at most `rays` of these shared among them by what they may bring: fewer where
    /// spots are the lesser part of what makes rays differ.
    std::vector<SpotCone> cones_from(const Vec3& p, const Vec3& n, int rays) const;

    std::size_t size() const { return spots_.size(); }

  private:
    struct Spot {
        Vec3 centre;
        float radius;    ///< [m]
        double radiance; ///< root of the mean square of what rays brought from there [W/(m^2 sr)]
    };

    std::optional<SpotCone> cone_of(std::size_t i, const Vec3& p, const Vec3& n) const;

    std::vector<Spot> spots_;
    double share_ = 0; ///< that all spots have of the second moment of what rays bring
};

} // namespace keyhole
