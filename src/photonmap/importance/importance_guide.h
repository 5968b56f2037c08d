// A cheap picture of where photons will be asked for: it steers, and never enters a photon's power.
#pragma once

#include "photonmap/irradiance/irradiance_map.h"
#include "sampling/paths/path.h"

namespace keyhole {

/// Importance of light at a surface, estimated beforehand at some importons (Christensen 1999, on the adjoint) and read
/// from the nearest of them: a tenth of the time of ImportanceMap, and as rough. Immutable and thread-safe.
class ImportanceGuide {
  public:
    /// `importons` is only read here. `scene`, which must outlive the guide, is for walls that hide importons; without
    /// one importance may leak past them.
    ImportanceGuide(const PhotonMap& importons, float max_radius, const SurfacePatches& patches, const Scene* scene,
                    const RunContext& context)
        : places_(some(importons), PhotonMap::Wanted::one),
          map_(places_, importons,
               {.k = 30, .max_radius = max_radius, .patches = &patches, .most_hidden = kMostHidden, .scene = scene},
               context) {}
    ImportanceGuide(const ImportanceGuide&) = delete; // map_ refers to places_
    ImportanceGuide& operator=(const ImportanceGuide&) = delete;

    /// Luminance that the picture gains, on average over its window, from light of RGB `power` [W] that arrives at `v`
    /// from `to_light`: about Y(power E). None where no importon is near: nothing is known there.
    std::optional<double> visible_power(const Vertex& v, const Vec3& to_light, const Rgb& power) const;

    std::size_t bytes() const { return places_.bytes() + map_.bytes(); }

  private:
    /// Behind the outer faces of walls a lookup finds one hidden importon after the other: rays that are better spent
    /// on light paths. Where that many are hidden nothing is known, and photons share what is kept for such places.
    static constexpr int kMostHidden = 4;

    /// Importons that stand in for pilot photons. They count as main photons as well, which a guide can afford.
    static std::vector<Photon> some(const PhotonMap& importons);

    PhotonMap places_;
    IrradianceMap map_;
};

} // namespace keyhole
