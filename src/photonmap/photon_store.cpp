#include "photonmap/photon_store.h"

#include <algorithm>

namespace keyhole {

PhotonStore::PhotonStore(std::size_t capacity, double initial_threshold, const Rng& rng)
    : capacity_(capacity), threshold_(initial_threshold), rng_(rng) {
    assert(initial_threshold >= 0);
    photons_.reserve(capacity);
    weights_.reserve(capacity);
}

void PhotonStore::absorb(PhotonBuffer& buffer) {
    for (std::size_t i = 0; i < buffer.photons.size(); ++i) deposit(buffer.photons[i], buffer.weights[i]);
    buffer.photons.clear();
    buffer.weights.clear();
}

double PhotonStore::admit(double weight) {
    if (weight == 0 || capacity_ == 0) return 0;
    weight = roulette(weight, threshold_, rng_);
    // The new photon has to meet the higher threshold like the stored ones.
    while (weight > 0 && photons_.size() == capacity_) {
        raise_threshold();
        weight = roulette(weight, threshold_, rng_);
    }
    return weight;
}

void PhotonStore::raise_threshold() {
    // Twice the smallest weight where there was no threshold yet; more rounds follow if that makes no room.
    threshold_ = 2 * (threshold_ > 0 ? threshold_ : *std::min_element(weights_.begin(), weights_.end()));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < photons_.size(); ++i) {
        const double weight = roulette(weights_[i], threshold_, rng_);
        if (weight == 0) continue;
        photons_[kept] = photons_[i];
        weights_[kept++] = static_cast<float>(weight);
    }
    photons_.erase(photons_.begin() + static_cast<std::ptrdiff_t>(kept), photons_.end());
    weights_.resize(kept);
}

void PhotonStore::release_into(std::vector<Photon>& out, double scale) {
    for (std::size_t i = 0; i < photons_.size(); ++i) {
        photons_[i].set_power(photons_[i].power() * (weights_[i] * scale));
        out.push_back(photons_[i]);
    }
    std::vector<Photon>().swap(photons_);
    std::vector<float>().swap(weights_);
}

} // namespace keyhole
