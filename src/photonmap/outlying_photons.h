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
    OutlyingPhotons() : photons_({}) {}
    /// Takes their power from `map`. Regions of lookups are those of queries for `k` photons within `max_radius` [m]
    /// that shrink by `shrink` (PhotonQuery). `patches`: whose area is lit; null: discs. The same on any number of
    /// threads.
    OutlyingPhotons(PilotedMap& map, int k, float max_radius, float shrink, const SurfacePatches* patches);

    /// The region that a photon lights.
    struct Lit {
        float radius; ///< [m]
        double area;  ///< of surface in it [m^2]
    };

    std::size_t size() const { return lit_.size(); }

    /// Calls visit(photon, lit) for those whose regions reach the middle of `region`.
    template <class Visit> void for_each_reaching(const SurfaceRegion& region, const Visit& visit) const {
        if (lit_.empty()) return;
        photons_.for_each_within(region, most_, [&](const Photon& photon) {
            const Lit& lit = lit_[static_cast<std::size_t>(&photon - photons_.photons().data())];
            if (region.distance2(photon.position()) <= lit.radius * lit.radius) visit(photon, lit);
        });
    }

  private:
    PhotonMap photons_;
    std::vector<Lit> lit_; ///< by each
    float most_ = 0;       ///< radius [m]
};

} // namespace keyhole
