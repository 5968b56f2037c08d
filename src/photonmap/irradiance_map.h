// Irradiance computed beforehand at some of the photons (Christensen 1999, "Faster Photon Map Global Illumination").
#pragma once

#include "core/progress.h"
#include "photonmap/density_estimate.h"
#include "scene/scene.h"

namespace keyhole {

struct IrradianceOptions {
    int k = 60;                              ///< photons in an estimate
    float max_radius;                        ///< [m]
    float shrink = 1;                        ///< of regions, as in PhotonQuery
    int stride = 4;                          ///< one estimate for so many photons
    const SurfacePatches* patches = nullptr; ///< for the area at edges; null: the disc's
    const Scene* scene = nullptr; ///< for walls that stand on a surface and part it; needs `patches`; null: none do
};

/// Answers with the estimate at the nearest of the chosen photons on the same piece of surface. Where other surfaces
/// stand on it, photons and estimates that they hide don't count: a floor that goes on beneath a wall would let light
/// through. Immutable and thread-safe once built.
class IrradianceMap {
  public:
    /// `photons` is only read here.
    IrradianceMap(const PhotonMap& photons, const IrradianceOptions& options, const RunContext& context);

    struct Answer {
        Rgb irradiance{0.0};     ///< W/m^2, through the geometric surface
        bool known = false;      ///< false: no estimate of this surface within 4 max_radius; irradiance is 0
        std::uint32_t place = 0; ///< index among places()
    };

    /// Irradiance on the side of unit `normal`.
    Answer irradiance(const Vec3& position, const Vec3& normal) const;

    /// Where irradiance was estimated.
    std::span<const Photon> places() const { return map_.photons(); }

    std::size_t bytes() const { return map_.bytes(); }
    /// Mean number of photons that went into an estimate.
    double mean_photons() const { return mean_photons_; }

  private:
    double mean_photons_ = 0; // filled in while map_ is made
    PhotonMap map_;           // the direction of an estimate is its normal, unless something stands around it
    float max_radius_;
    const Scene* scene_;
};

} // namespace keyhole
