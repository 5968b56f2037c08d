// The stores of both photon maps, for pilot photons and main photons.
#pragma once

#include "core/shared_work.h"
#include "photonmap/photon_store.h"
#include "photonmap/photons.h"
#include "sampling/paths/path.h"

#include <cstdint>
#include <optional>

namespace keyhole {

/// Photon::spare() where light that `scatterings` vertices have scattered, that of the photon included, is stored.
inline int spare_scatterings(PhotonKind kind, int scatterings, int max_scatterings) {
    return max_scatterings - scatterings - (kind == PhotonKind::global ? 1 : 0); // d1 is still to come
}

/// What waits for the stores of either map.
struct MapBuffers {
    PhotonBuffer global, caustic;

    PhotonBuffer& of(PhotonKind kind) { return kind == PhotonKind::global ? global : caustic; }
    auto parts() { return std::tie(global, caustic); }
};

/// Stores for what a sampler finds; both maps together hold no more than they were made for. Not thread-safe.
class MapStores {
  public:
    struct Thresholds {
        double global = 0, caustic = 0;

        double of(PhotonKind kind) const { return kind == PhotonKind::global ? global : caustic; }
    };

    /// Photons of either map at most, pilot photons included.
    struct Ceilings {
        std::size_t global = 0, caustic = 0;
    };

    /// @param unit of the power of the photons that come (unit_of_power())
    /// @param initial as PhotonStore's
    MapStores(const Ceilings& ceilings, double unit, const Thresholds& initial, std::uint64_t seed);

    /// Adds the photons of the buffers and empties them.
    void absorb(PhotonRole role, MapBuffers& buffers);
    /// The same for those of all chains, in their order; a process group shares chains out, each process has filled the
    /// buffers of its own_part(). role_of(c) is the role of chain c.
    template <class RoleOf> void absorb(std::vector<MapBuffers>& buffers, RoleOf&& role_of, const RunContext& context) {
        exchange_parts(buffers, context);
        for (std::size_t c = 0; c < buffers.size(); ++c) absorb(role_of(c), buffers[c]);
    }

    /// Weights below these won't stay whole.
    Thresholds thresholds(PhotonRole role) const;

    /// As PhotonStore's. Weights of pilot photons change units as the others' do.
    void settle(double global_scale, double caustic_scale, double next);

    /// All photons, with power times weight times unit and the map's scale. The stores are finished after that.
    Photons release(double global_scale, double caustic_scale);

    /// Memory held [bytes].
    std::size_t bytes() const;

  private:
    struct Pair {
        PhotonStore global, caustic;
    };
    static Pair make_pair(const Ceilings& ceilings, const Thresholds& initial, std::uint64_t seed, PhotonRole role);
    Pair& of(PhotonRole role) { return role == PhotonRole::pilot ? pilots_ : main_photons_; }

    Pair pilots_, main_photons_;
    double unit_;
};

/// Puts a photon of weight `weight` into its buffer if it survives the roulette of its store: what doesn't costs
/// nothing more. make(kept) makes it, where `kept` is its weight after the roulette: a Photon, or an optional one, that
/// is left out if there is none.
template <class Make>
void store_by_roulette(MapBuffers& buffers, PhotonKind kind, double weight, const MapStores::Thresholds& thresholds,
                       Rng& rng, Make&& make) {
    const double kept = roulette(weight, thresholds.of(kind), rng);
    if (!(kept > 0)) return;
    const std::optional<Photon> photon = make(kept);
    if (!photon) return;
    PhotonBuffer& buffer = buffers.of(kind);
    buffer.photons.push_back(*photon);
    buffer.weights.push_back(static_cast<float>(kept));
}

/// How many of so many photons are for the caustic map, where it has that share [0, 1] of their weight. Either map
/// keeps a few, should the share have been found by too few samples.
std::size_t photons_for_caustic(double share, std::size_t photons);

/// Steps of each chain between two visits to the stores, so that the chains' buffers stay small beside these.
std::int64_t round_length(std::int64_t photons, std::int64_t chains);

} // namespace keyhole
