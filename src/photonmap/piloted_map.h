// A photon map whose lookups are sized by pilot photons.
#pragma once

#include "photonmap/density_estimate.h"
#include "photonmap/photons.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace keyhole {

/// The index of a PhotonSet. Thread-safe but for put_out().
class PilotedMap {
  public:
    explicit PilotedMap(PhotonSet photons)
        : pilots_(std::move(photons.pilots), PhotonMap::Wanted::one), main_photons_(std::move(photons.main_photons)) {}

    const PhotonMap& pilots() const { return pilots_; }
    const PhotonMap& main_photons() const { return main_photons_; }
    /// Takes the power of a main photon. Not while others ask.
    void put_out(std::uint32_t i) { main_photons_.put_out(i); }
    std::size_t size() const { return pilots_.photons().size() + main_photons_.photons().size(); }
    std::size_t bytes() const { return pilots_.bytes() + main_photons_.bytes(); }

  private:
    PhotonMap pilots_, main_photons_;
};

/// A region's radius, and the pilot photon nearest to its middle.
struct PilotedRegion {
    float radius;                         ///< [m]
    std::optional<std::uint32_t> nearest; ///< its index, where one is in reach of the query
};

/// Region in which about `k` main photons are to be expected: up to the pilot photon that has so many pilot photons
/// nearer, and at most max_radius. `own`: pilot photons to leave out because the region was put where they are.
inline PilotedRegion piloted_region(const PhotonMap& pilots, const PhotonQuery& query, int own = 0) {
    PhotonQuery among = query;
    among.k = std::max(1, query.k / (kPilotEvery - 1)) + own;
    const Neighbourhood near = pilots.nearest(among);
    PilotedRegion region{query.shrink * std::sqrt(near.radius2), std::nullopt};
    if (!near.found.empty()) region.nearest = std::min_element(near.found.begin(), near.found.end())->index;
    return region;
}

/// Its radius alone.
inline float piloted_radius(const PhotonMap& pilots, const PhotonQuery& query, int own = 0) {
    return piloted_region(pilots, query, own).radius;
}

/// estimate_density() over the main photons in a region that the pilot photons decide. Its expectation is the mean
/// density of the region, whatever the photons know of each other.
template <class Weight>
DensityEstimate estimate_density(const PilotedMap& map, const PhotonQuery& query, const SurfacePatches* patches,
                                 Weight&& weight) {
    return estimate_density(map.main_photons(), query.region, piloted_radius(map.pilots(), query), patches, weight);
}

} // namespace keyhole
