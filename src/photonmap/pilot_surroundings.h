// What pilot photons tell of their surroundings: what surface lies there, and how close photons are to each other.
#pragma once

#include "photonmap/piloted_map.h"
#include "photonmap/surface/density_in_sight.h"

#include <atomic>
#include <vector>

namespace keyhole {

/// Remembers what surroundings_of() says around each pilot photon of a map, relative to the radius of the region there.
/// A lookup takes the answer of the pilot photon nearest to it in place of its own, which takes eight to hundreds of
/// rays on fine meshes, and there are hundreds of lookups for each pilot photon; but not where a wall may part the two,
/// or stand nearer to the lookup. Thread-safe: what is remembered depends on the pilot photon alone, whoever asks
/// first.
class PilotSurroundings {
  public:
    /// Refers to `map` and `patches`. The regions are those of queries for `k` photons within `max_radius` [m] that
    /// shrink by `shrink` (PhotonQuery).
    PilotSurroundings(const PilotedMap& map, const SurfacePatches& patches, int k, float max_radius, float shrink);

    /// Whether only what the middle of a region sees counts there.
    bool partly_occluded(const SurfaceRegion& region, const PilotedRegion& piloted) const;
    /// Around the region of a lookup that the pilot photons have sized. At an edge of the surface its own area is
    /// measured: the pilot photons near by lie farther from the edge than a lookup at it.
    Surroundings around(const SurfaceRegion& region, const PilotedRegion& piloted) const;

    /// Radius of the region around a main photon itself [m], which says how close others are to it.
    float radius(const Photon& photon) const;

    std::size_t bytes() const { return (known_.size() + radii_.size()) * sizeof(Packed); }

  private:
    /// Share of the disc in steps of 1/255, a flag, and how far nothing stands around; 0: nobody asked yet.
    using Packed = std::uint16_t;
    /// What is known around the lookup's region from the pilot photon nearest to it; none: that it has to measure.
    std::optional<Packed> known_around(const SurfaceRegion& region, const PilotedRegion& piloted) const;
    Packed at(std::uint32_t pilot) const;
    Packed measure(const Photon& pilot) const;
    Surroundings own(const SurfaceRegion& region, float r) const;

    const PhotonMap &pilots_, &main_photons_;
    const SurfacePatches& patches_;
    int k_;
    float max_radius_, shrink_;
    mutable std::vector<std::atomic<Packed>> known_;
    mutable std::vector<std::atomic<std::uint16_t>> radii_; ///< by photon, logarithms; 0: nobody asked yet
};

} // namespace keyhole
