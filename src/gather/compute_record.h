// Records of the irradiance cache.
#pragma once

#include "gather/irradiance_cache.h"
#include "gather/spots/hot_spots.h"
#include "gather/visible_point.h"

#include <cstdint>
#include <limits>

namespace keyhole {

struct CacheOptions {
    double error = 0.3;             ///< reach of a record over its distance to surrounding surfaces
    int rays = 400;                 ///< of records' hemispheres on average; hot spots get half as many on top
    double min_radius = 4;          ///< [pixels], as wide as one is at the record's distance from the eye
    double max_radius = 60;         ///< [pixels]
    double min_radius_by_light = 4; ///< [pixels], see IrradianceRecord
    double overlap = 1;             ///< how many times its radius a record is used
    double doubt = 1.0 / 3;         ///< over `error`: by how much records may predict each other wrongly
    double rays_for_pixel = std::numeric_limits<double>::infinity(); ///< as RunContext's
    std::uint64_t seed = 1;
};

/// Immutable and thread-safe.
class RecordMaker {
  public:
    /// All must outlive this.
    RecordMaker(const GatherRays& rays, const HotSpots& spots, const CacheOptions& options)
        : rays_(rays), spots_(spots), options_(options) {}

    /// Irradiance at `c`, directions weighed as its diffuse part weighs them, by a hemisphere of about `count` rays,
    /// from the random stream `stream`. They find what doesn't come from hot spots; each of these has rays of its own,
    /// in the cone that it fills, so that no record depends on whether one of its few hundred rays happens to meet it.
    HemisphereEstimate light(const VisiblePoint& c, int count, std::uint64_t stream) const;

    /// The record at `c` with that light.
    IrradianceRecord compute(const VisiblePoint& c, int count, std::uint64_t stream) const;

    const GatherRays& rays() const { return rays_; }

  private:
    float min_radius(const VisiblePoint& c) const { return static_cast<float>(options_.min_radius * c.pixel); }
    /// The first of a record's cones in whose spot a place lies; null if it lies in none.
    const SpotCone* spot_of(const Vec3& place, std::span<const SpotCone> cones) const;
    void add_spot(const VisiblePoint& c, const Frame& frame, const SpotCone& cone, std::span<const SpotCone> cones,
                  Rng& rng, HemisphereEstimate& sum) const;

    const GatherRays& rays_;
    const HotSpots& spots_;
    const CacheOptions& options_;
};

} // namespace keyhole
