// Stage three: what the eye sees, from direct light, the caustic map, and gather rays that ask the global map and find
// direct light at what they hit.
#pragma once

#include "core/pixel_sample.h"
#include "photonmap/irradiance_map.h"
#include "sampling/walk.h"

namespace keyhole {

/// What stage three asks. Maps may be null: nothing of that kind was found.
struct GatherMaps {
    const PhotonMap* global = nullptr;
    const IrradianceMap* irradiance = nullptr; ///< of the global map
    const PhotonMap* caustic = nullptr;
    const SurfacePatches* patches = nullptr;
};

struct GatherOptions {
    int rays = 4;         ///< gather rays from each visible point
    int nearest = 60;     ///< photons in a radiance estimate
    float max_radius;     ///< of a lookup in the global map [m]
    float caustic_radius; ///< of a lookup in the caustic map [m]
    float shrink = 1;     ///< of lookup regions, as in PhotonQuery
    int max_scatterings = 24;
};

/// Immutable and thread-safe.
class FinalGather {
  public:
    FinalGather(const Scene& scene, const GatherMaps& maps, const GatherOptions& options)
        : scene_(scene), maps_(maps), options_(options) {}

    /// Estimates what arrives at the eye through window point `image`. Unbiased but for the maps.
    PixelSample sample(const Vec2& image, SampleSource& source) const;

  private:
    /// Everything that the finite scattering at the last two vertices seen does: direct light, caustic, gather rays.
    void shade(const Vertex& v, const Vec3& back, const Rgb& throughput, int scatterings, SampleSource& source,
               PixelSample& out) const;
    Rgb direct_light(const Vertex& v, const Vec3& back, SampleSource& source) const;
    /// Direct light where no gather rays follow that would meet emitters: both techniques, one sample each.
    Rgb direct_light_alone(const Vertex& v, const Vec3& back, SampleSource& source) const;
    /// One gather ray; `direct` takes its share of direct light (MIS against direct_light()).
    Rgb gather_ray(const Vertex& from, const Vec3& back, int scatterings, SampleSource& source, PixelSample& out,
                   Rgb& direct) const;
    /// Radiance that the global map gives at `v` towards `back`.
    Rgb ask_global_map(const Vertex& v, const Vec3& back, PixelSample& out) const;
    Rgb ask_caustic_map(const Vertex& v, const Vec3& back) const;

    const Scene& scene_;
    GatherMaps maps_;
    GatherOptions options_;
};

} // namespace keyhole
