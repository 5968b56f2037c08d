// Fills the irradiance cache for what the camera sees.
#pragma once

#include "core/progress.h"
#include "core/settings.h"
#include "gather/gather_rays.h"
#include "gather/irradiance_cache.h"

#include <cstdint>

namespace keyhole {

struct CacheOptions {
    double error = 0.3;     ///< reach of a record over its distance to surrounding surfaces
    int rays = 400;         ///< of a record's hemisphere
    double min_radius = 4;  ///< [pixels], as wide as one is at the record's distance from the eye
    double max_radius = 60; ///< [pixels]
    std::uint64_t seed = 1;
};
CacheOptions cache_options(const Settings& settings, std::uint64_t seed);

/// Records where the eye's rays, through glass and by mirrors, meet near-Lambertian surfaces and the cache knows
/// nothing yet: first at every 16th pixel in each direction, then between them down to each pixel, twice. Points are
/// taken in a fixed order and records computed so many at a time, whatever the number of threads, so that the cache
/// does not depend on it. A stop leaves what there is.
IrradianceCache fill_cache(const GatherRays& rays, const CacheOptions& options, const RunContext& context);

/// Shading normal on the side of `back`: what records are kept by.
Vec3 cache_normal(const Vertex& v, const Vec3& back);

} // namespace keyhole
