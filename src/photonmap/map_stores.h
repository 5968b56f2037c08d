// The stores of both photon maps, for scouts and carriers.
#pragma once

#include "photonmap/photon_store.h"
#include "photonmap/photons.h"

#include <cstdint>

namespace keyhole {

/// What waits for the stores of either map.
struct MapBuffers {
    PhotonBuffer global, caustic;

    auto parts() { return std::tie(global, caustic); }
};

/// Stores for what a sampler finds; both maps together hold no more than they were made for. Not thread-safe.
class MapStores {
  public:
    struct Thresholds {
        double global = 0, caustic = 0;
    };

    /// Ceilings in photons, scouts included. `initial`: as PhotonStore's.
    MapStores(std::size_t global, std::size_t caustic, const Thresholds& initial, std::uint64_t seed);

    /// Adds the photons of the buffers and empties them.
    void absorb(PhotonRole role, MapBuffers& buffers);

    /// Weights below these won't stay whole.
    Thresholds thresholds(PhotonRole role) const;

    /// All photons, with power times weight times the map's scale. The stores are finished after that.
    Photons release(double global_scale, double caustic_scale);

    /// Memory held [bytes].
    std::size_t bytes() const;

  private:
    struct Pair {
        PhotonStore global, caustic;
    };
    static Pair make_pair(std::size_t global, std::size_t caustic, const Thresholds& initial, std::uint64_t seed,
                          PhotonRole role);
    Pair& of(PhotonRole role) { return role == PhotonRole::scout ? scouts_ : carriers_; }

    Pair scouts_, carriers_;
};

/// Steps of each chain between two visits to the stores, so that the chains' buffers stay small beside these.
std::int64_t round_length(std::int64_t photons, std::int64_t chains);

} // namespace keyhole
