// Stores of photons under a hard ceiling, and those of both photon maps, for pilot photons and main photons.
#pragma once

#include "core/rng.h"
#include "core/shared_work.h"
#include "photonmap/photon.h"
#include "photonmap/photons.h"
#include "sampling/paths/path.h"

#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

namespace keyhole {

/// Russian roulette on a weight: below `threshold` it survives with probability weight / threshold and is `threshold`
/// then; 0 where it doesn't. Keeps the expectation.
inline double roulette(double weight, double threshold, Rng& rng) {
    if (weight >= threshold) return weight;
    return rng.next() * threshold < weight ? threshold : 0.0;
}

/// What waits for a store, in order.
struct PhotonBuffer {
    std::vector<Photon> photons;
    std::vector<float> weights;

    auto parts() { return std::tie(photons, weights); }
};

/// Collects weighted photons and never holds more than its capacity. Weights below a threshold t survive with
/// probability w / t and then weigh t; when the store is full, t rises so far that a tenth of what is stored should
/// fall in the same roulette. Every region's total keeps its expectation whatever is thinned. Not thread-safe. Depends
/// on nothing but the deposits, their order and its own random stream.
class PhotonStore {
  public:
    /// Memory for `capacity` photons is taken at once, or, where there isn't so much, as they come. With a capacity of
    /// 0 everything is dropped.
    PhotonStore(std::size_t capacity, double initial_threshold, const Rng& rng);

    /// Adds the photons of a buffer, power times weight, and empties it.
    void absorb(PhotonBuffer& buffer);

    /// Adds power `weight` times that of `photon`; weight >= 0. One that no float holds is left out.
    void deposit(const Photon& photon, double weight) {
        weight = admit(weight);
        if (weight == 0) return;
        photons_.push_back(photon);
        weights_.push_back(static_cast<float>(weight));
    }

    /// Ends a part whose photons get `scale` in the end; weights of what comes after it count in units of `next`, the
    /// scale that it is expected to get.
    void settle(double scale, double next);

    /// All photons, with power times weight times `scale`, those of a settled part times theirs. The store gives its
    /// memory back or away, as little of it as half of it has room for beside, and is finished after that.
    std::vector<Photon> release(double scale);

    std::size_t size() const { return photons_.size(); }
    double threshold() const { return threshold_; }
    /// Memory that is there for photons, held or not [bytes].
    std::size_t bytes() const { return photons_.capacity() * sizeof(Photon) + weights_.capacity() * sizeof(float); }
    /// Of that, what photons have lain in: the rest is only promised by the system.
    std::size_t bytes_held() const;
    /// Memory that a store holds for one photon of its capacity [bytes].
    static constexpr std::size_t bytes_per_photon() { return sizeof(Photon) + sizeof(float); }

  private:
    /// The weight after roulette and after making room for one more photon; the threshold may rise.
    double admit(double weight);
    /// Raises the threshold so far that a tenth of what is stored should go, and sends it through the roulette.
    void raise_threshold();
    /// Number of stored photons that a threshold of `t` should leave.
    double expected_survivors(double t) const;

    std::vector<Photon> photons_;
    std::vector<float> weights_; // of photons_
    std::size_t capacity_;
    double threshold_;
    std::size_t most_ = 0;    // photons that there have been, before they were thinned
    std::size_t settled_ = 0; // photons, the first ones
    double settled_scale_ = 1;
    Rng rng_;
};

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

    /// As PhotonStore's.
    std::size_t bytes_held() const;

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
