// A photon map whose lookups are sized by scouts.
#pragma once

#include "photonmap/density_estimate.h"
#include "photonmap/photons.h"

#include <cmath>
#include <utility>

namespace keyhole {

/// The index of a PhotonSet. Immutable and thread-safe.
class ScoutedMap {
  public:
    explicit ScoutedMap(PhotonSet photons)
        : scouts_(std::move(photons.scouts), PhotonMap::Wanted::one), carriers_(std::move(photons.carriers)) {}

    const PhotonMap& scouts() const { return scouts_; }
    const PhotonMap& carriers() const { return carriers_; }
    std::size_t bytes() const { return scouts_.bytes() + carriers_.bytes(); }

  private:
    PhotonMap scouts_, carriers_;
};

/// Radius of the region in which about `k` carriers are to be expected [m]: up to the scout that has so many scouts
/// nearer, and at most max_radius. `own`: scouts to leave out because the region was put where they are.
inline float scouted_radius(const PhotonMap& scouts, const PhotonQuery& query, int own = 0) {
    PhotonQuery among = query;
    among.k = std::max(1, query.k / (kScoutEvery - 1)) + own;
    return query.shrink * std::sqrt(scouts.nearest(among).radius2);
}

/// estimate_density() over the carriers in a region that the scouts decide. Its expectation is the mean density of the
/// region, whatever the photons know of each other.
template <class Weight>
DensityEstimate estimate_density(const ScoutedMap& map, const PhotonQuery& query, const SurfacePatches* patches,
                                 Weight&& weight) {
    return estimate_density(map.carriers(), query.region, scouted_radius(map.scouts(), query), patches, weight);
}

} // namespace keyhole
