// Fills the irradiance cache for what the camera sees.
#pragma once

#include "core/progress.h"
#include "core/settings.h"
#include "gather/compute_record.h"

#include <functional>

namespace keyhole {

/// @param shrink see Radii: later passes have more records with fewer rays each, for about the same time. What
/// interpolation makes wrong shrinks from pass to pass like what lookups do; noise goes with the number of passes.
CacheOptions cache_options(const Settings& settings, double shrink, std::uint64_t seed);

/// What is small and bright, for records of so many rays.
HotSpots find_hot_spots(const GatherRays& rays, const CacheOptions& options, const RunContext& context);

/// Records that have their first rays.
struct PlacedRecords {
    const IrradianceCache& cache;
    int rays;       ///< that each has
    double seconds; ///< that it took, by StopToken::seconds_left(); 0 where no time is limited
};
/// Rays that records shall have in the end, on average.
using RaysOfRecords = std::function<int(const PlacedRecords&)>;

/// Records where the eye's rays, through glass and by mirrors, meet near-Lambertian surfaces and the cache knows
/// nothing yet: first at every 16th pixel in each direction, then between them down to each pixel, twice. Points are
/// taken in a fixed order and records computed so many at a time, whatever the number of threads, so that the cache
/// does not depend on it. A stop leaves what there is.
/// @param spots that records look at with rays of their own.
/// @param decide asked once records are placed; without it, they get as many rays as the options say.
IrradianceCache fill_cache(const GatherRays& rays, const HotSpots& spots, const CacheOptions& options,
                           const RunContext& context, const RaysOfRecords& decide = {});

} // namespace keyhole
