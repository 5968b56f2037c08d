// A cheap picture of where photons will be asked for: it steers, and never enters a photon's power.
#pragma once

#include "photonmap/irradiance_map.h"
#include "sampling/path.h"

namespace keyhole {

/// Importance of light at a surface, estimated beforehand at some importons (Christensen 1999, on the adjoint) and read
/// from the nearest of them: a tenth of the time of ImportanceMap, and as rough. Immutable and thread-safe.
class ImportanceGuide {
  public:
    /// `importons` is only read here.
    ImportanceGuide(const PhotonMap& importons, float max_radius, const SurfacePatches& patches,
                    const RunContext& context)
        : map_(importons, {.k = 30, .max_radius = max_radius, .stride = 4, .patches = &patches}, context) {}

    /// Luminance that the picture gains, on average over its window, from light of RGB `power` [W] that arrives at `v`
    /// from `to_light`: about Y(power E). None where no importon is near: nothing is known there.
    std::optional<double> visible_power(const Vertex& v, const Vec3& to_light, const Rgb& power) const;

    std::size_t bytes() const { return map_.bytes(); }

  private:
    IrradianceMap map_;
};

} // namespace keyhole
