// Photons under a hard ceiling.
#pragma once

#include "core/rng.h"
#include "photonmap/photon.h"

#include <cassert>
#include <cmath>
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
    /// Memory for `capacity` photons is taken at once. With a capacity of 0 everything is dropped.
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
    /// memory back or away and is finished after that.
    std::vector<Photon> release(double scale);

    std::size_t size() const { return photons_.size(); }
    double threshold() const { return threshold_; }
    /// Memory held [bytes].
    std::size_t bytes() const { return photons_.capacity() * sizeof(Photon) + weights_.capacity() * sizeof(float); }
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
    std::size_t settled_ = 0; // photons, the first ones
    double settled_scale_ = 1;
    Rng rng_;
};

} // namespace keyhole
