// Photons that light the whole region of a lookup though no others came there: seen at once they are bright discs.
#pragma once

#include "photonmap/piloted_map.h"

#include <vector>

namespace keyhole {

/// Main photons of a piloted map that each light a region of its own, wider than that of a lookup: a kernel of a
/// variable width (Breiman, Meisel and Purcell 1977). As much light, from so much more surface that the other photons
/// there outshine it, or that it is faint. Immutable and thread-safe.
class OutlyingPhotons {
  public:
    /// None.
    OutlyingPhotons() : photons_({}) {}
    /// Takes them out of `map`. Regions of lookups are those of queries for `k` photons within `max_radius` [m] that
    /// shrink by `shrink` (PhotonQuery). The same on any number of threads.
    OutlyingPhotons(PilotedMap& map, int k, float max_radius, float shrink);

    std::size_t size() const { return radii_.size(); }
    std::size_t bytes() const { return photons_.bytes() + radii_.size() * sizeof(float); }

    /// Calls visit(photon, radius) for those whose regions, of radius `radius` [m], reach the middle of `region`.
    template <class Visit> void for_each_reaching(const SurfaceRegion& region, const Visit& visit) const {
        if (radii_.empty()) return;
        photons_.for_each_within(region, most_, [&](const Photon& photon) {
            const float r = radii_[static_cast<std::size_t>(&photon - photons_.photons().data())];
            if (region.distance2(photon.position()) <= r * r) visit(photon, r);
        });
    }

  private:
    PhotonMap photons_;
    std::vector<float> radii_; ///< [m]
    float most_ = 0;
};

} // namespace keyhole
