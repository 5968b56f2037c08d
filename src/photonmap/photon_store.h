// Photons of one chain, under a hard ceiling.
#pragma once

#include "core/rng.h"
#include "photonmap/photon.h"

#include <vector>

namespace keyhole {

/// Collects weighted photons and never holds more than its capacity. Weights below a threshold t survive with
/// probability w / t and then weigh t; when the store is full, t rises and what is stored goes through the same
/// roulette. Every region's total keeps its expectation whatever is thinned. Not thread-safe: one for each chain.
/// Depends on nothing but the deposits and its own random stream.
class PhotonStore {
  public:
    /// Memory for `capacity` photons (> 0) is taken at once.
    PhotonStore(std::size_t capacity, double initial_threshold, const Rng& rng);

    /// Adds power `weight` times that of `photon`; weight >= 0. Deposits of one and the same photon that follow
    /// closely, as those of a chain that stands still or that keeps its light sub-path, become one.
    void deposit(const Photon& photon, double weight);

    /// Appends all photons to `out`, with power times weight times `scale`, and gives the memory back. The store is
    /// finished after that.
    void release_into(std::vector<Photon>& out, double scale);

    std::size_t size() const { return photons_.size(); }
    double threshold() const { return threshold_; }
    /// Memory held [bytes].
    std::size_t bytes() const { return photons_.capacity() * sizeof(Photon) + weights_.capacity() * sizeof(float); }
    /// Memory that a store holds for one photon of its capacity [bytes].
    static constexpr std::size_t bytes_per_photon() { return sizeof(Photon) + sizeof(float); }

  private:
    /// A deposit that may still grow. Two: a chain's current state and its proposal take turns.
    struct Pending {
        Photon photon{Vec3(0), Vec3(0, 0, 1), Vec3(0, 0, 1), Rgb(0.0)};
        double weight = 0;
    };

    /// The weight after roulette against the threshold: w, t or 0.
    double roulette(double weight);
    void store(const Pending& pending);
    /// Doubles the threshold and sends what is stored through the roulette.
    void raise_threshold();

    std::vector<Photon> photons_;
    std::vector<float> weights_; // of photons_
    Pending recent_, older_;
    std::size_t capacity_;
    double threshold_;
    Rng rng_;
};

} // namespace keyhole
