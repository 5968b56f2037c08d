// Records of the irradiance cache.
#pragma once

#include "gather/bright_spots.h"
#include "gather/irradiance_cache.h"
#include "gather/visible_point.h"

#include <cstdint>

namespace keyhole {

struct CacheOptions {
    double error = 0.3;     ///< reach of a record over its distance to surrounding surfaces
    int rays = 400;         ///< of a record's hemisphere; bright spots get half as many on top
    double min_radius = 4;  ///< [pixels], as wide as one is at the record's distance from the eye
    double max_radius = 60; ///< [pixels]
    double overlap = 1;     ///< how many times its radius a record is used
    std::uint64_t seed = 1;
};

/// Immutable and thread-safe.
class RecordMaker {
  public:
    /// All must outlive this.
    RecordMaker(const GatherRays& rays, const BrightSpots& spots, const CacheOptions& options)
        : rays_(rays), spots_(spots), options_(options), grid_(options.rays) {}

    /// The record at `c`, from the random stream `index`. The hemisphere of rays finds what doesn't come from bright
    /// spots; each of these has rays of its own, in the cone that it fills, so that no record depends on whether one
    /// of its few hundred rays happens to meet it.
    IrradianceRecord compute(const VisiblePoint& c, std::uint64_t index) const;

    const GatherRays& rays() const { return rays_; }

  private:
    void add_spot(const VisiblePoint& c, const Frame& frame, const SpotCone& cone, Rng& rng,
                  HemisphereEstimate& sum) const;

    const GatherRays& rays_;
    const BrightSpots& spots_;
    const CacheOptions& options_;
    HemisphereGrid grid_;
};

} // namespace keyhole
