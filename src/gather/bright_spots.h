// Small places that are much brighter than what is around them, for gather rays to aim at.
#pragma once

#include "core/progress.h"
#include "gather/gather_rays.h"

#include <array>
#include <cstdint>
#include <unordered_map>
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

/// Cells of a grid from which gather rays brought far more than their share, found by some thousands of rays from what
/// the eye sees. Only where rays go depends on them, so that a spot which was missed costs noise, and no light.
/// Immutable and thread-safe.
class BrightSpots {
  public:
    /// None.
    BrightSpots() = default;
    BrightSpots(const GatherRays& rays, std::uint64_t seed, const RunContext& context);

    /// The spot that a place belongs to; -1: none.
    int spot_at(const Vec3& place) const;

    /// Cones of the spots that are worth aiming at from `p` with normal `n`, and at most `rays` rays shared among them
    /// by what they may bring: fewer where spots are the lesser part of what makes rays differ. Spots that surround `p`
    /// are left out.
    std::vector<SpotCone> cones_from(const Vec3& p, const Vec3& n, int rays) const;

    std::size_t size() const { return spots_.size(); }

  private:
    struct Spot {
        Vec3 centre;
        double radiance; ///< mean of what rays brought from there [W/(m^2 sr)]
    };
    std::uint64_t cell(const Vec3& place) const;

    Vec3 origin_{0, 0, 0};
    float width_ = 1;  ///< of a cell [m]
    float radius_ = 1; ///< of the sphere around it [m]
    std::unordered_map<std::uint64_t, int> index_;
    std::vector<Spot> spots_;
    double share_ = 0; ///< of the second moment of what rays bring
};

} // namespace keyhole
