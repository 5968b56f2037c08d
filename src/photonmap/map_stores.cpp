#include "photonmap/map_stores.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace keyhole {

PhotonStore::PhotonStore(std::size_t capacity, double initial_threshold, const Rng& rng)
    : capacity_(capacity), threshold_(initial_threshold), rng_(rng) {
    assert(initial_threshold >= 0);
    try {
        photons_.reserve(capacity);
        weights_.reserve(capacity);
    } catch (const std::exception&) { // more than there is: the photons may be fewer
        photons_.shrink_to_fit();
    }
}

std::size_t PhotonStore::bytes_held() const { return std::max(most_, photons_.size()) * bytes_per_photon(); }

void PhotonStore::absorb(PhotonBuffer& buffer) {
    for (std::size_t i = 0; i < buffer.photons.size(); ++i) deposit(buffer.photons[i], buffer.weights[i]);
    buffer.photons.clear();
    buffer.weights.clear();
}

double PhotonStore::admit(double weight) {
    // No threshold that is doubled comes near an infinite one.
    if (!(weight > 0) || !std::isfinite(static_cast<float>(weight)) || capacity_ == 0) return 0;
    weight = roulette(weight, threshold_, rng_);
    // The new photon has to meet the higher threshold like the stored ones.
    while (weight > 0 && photons_.size() == capacity_) {
        raise_threshold();
        weight = roulette(weight, threshold_, rng_);
    }
    return weight;
}

double PhotonStore::expected_survivors(double t) const {
    double sum = 0;
    for (const float w : weights_) sum += std::min(1.0, w / t);
    return sum;
}

void PhotonStore::raise_threshold() {
    // Bracketed by doubling, then bisected: no need to be exact, since survivors are counted anyway.
    const double wanted = 0.9 * static_cast<double>(capacity_);
    double low = std::max(threshold_, static_cast<double>(*std::min_element(weights_.begin(), weights_.end())));
    double high = 2 * low;
    for (; expected_survivors(high) > wanted; high *= 2) low = high;
    for (int i = 0; i < 5; ++i) {
        const double middle = (low + high) / 2;
        (expected_survivors(middle) > wanted ? low : high) = middle;
    }
    threshold_ = high;
    most_ = std::max(most_, photons_.size());
    std::size_t kept = 0, settled = 0;
    for (std::size_t i = 0; i < photons_.size(); ++i) {
        const double weight = roulette(weights_[i], threshold_, rng_);
        if (weight == 0) continue;
        photons_[kept] = photons_[i];
        weights_[kept++] = static_cast<float>(weight);
        if (i < settled_) settled = kept;
    }
    photons_.erase(photons_.begin() + static_cast<std::ptrdiff_t>(kept), photons_.end());
    weights_.resize(kept);
    settled_ = settled;
}

void PhotonStore::settle(double scale, double next) {
    for (float& w : weights_) w = static_cast<float>(w * (scale / next));
    settled_ = photons_.size();
    settled_scale_ = next;
    threshold_ = 0;
}

std::vector<Photon> PhotonStore::release(double scale) {
    for (std::size_t i = 0; i < photons_.size(); ++i)
        photons_[i].set_power(photons_[i].power() * (weights_[i] * (i < settled_ ? settled_scale_ : scale)));
    std::vector<float>().swap(weights_);
    most_ = 0;
    if (2 * photons_.size() <= photons_.capacity()) photons_.shrink_to_fit(); // both fit where one was promised
    return std::exchange(photons_, {});
}

MapStores::Pair MapStores::make_pair(const Ceilings& ceilings, const Thresholds& initial, std::uint64_t seed,
                                     PhotonRole role) {
    const auto share = [&](std::size_t ceiling) {
        const std::size_t pilots = ceiling / kPilotEvery;
        return role == PhotonRole::pilot ? pilots : ceiling - pilots;
    };
    const std::uint64_t stream = 2 * static_cast<std::uint64_t>(role);
    return {PhotonStore(share(ceilings.global), initial.global, Rng(seed, StreamPurpose::thinning, stream)),
            PhotonStore(share(ceilings.caustic), initial.caustic, Rng(seed, StreamPurpose::thinning, stream + 1))};
}

MapStores::MapStores(const Ceilings& ceilings, double unit, const Thresholds& initial, std::uint64_t seed)
    : pilots_(make_pair(ceilings, initial, seed, PhotonRole::pilot)),
      main_photons_(make_pair(ceilings, initial, seed, PhotonRole::main_photon)), unit_(unit) {}

void MapStores::absorb(PhotonRole role, MapBuffers& buffers) {
    of(role).global.absorb(buffers.global);
    of(role).caustic.absorb(buffers.caustic);
}

MapStores::Thresholds MapStores::thresholds(PhotonRole role) const {
    const Pair& pair = role == PhotonRole::pilot ? pilots_ : main_photons_;
    return {pair.global.threshold(), pair.caustic.threshold()};
}

void MapStores::settle(double global_scale, double caustic_scale, double next) {
    for (Pair* pair : {&pilots_, &main_photons_}) {
        pair->global.settle(global_scale * unit_, next * unit_);
        pair->caustic.settle(caustic_scale * unit_, next * unit_);
    }
}

Photons MapStores::release(double global_scale, double caustic_scale) {
    return {{pilots_.global.release(1), main_photons_.global.release(global_scale * unit_)},
            {pilots_.caustic.release(1), main_photons_.caustic.release(caustic_scale * unit_)}};
}

std::size_t MapStores::bytes_held() const {
    return pilots_.global.bytes_held() + pilots_.caustic.bytes_held() + main_photons_.global.bytes_held() +
           main_photons_.caustic.bytes_held();
}

std::size_t photons_for_caustic(double share, std::size_t photons) {
    return static_cast<std::size_t>(std::clamp(share, 0.02, 0.98) * static_cast<double>(photons));
}

std::int64_t round_length(std::int64_t photons, std::int64_t chains) {
    return std::clamp<std::int64_t>(photons / (32 * chains), 2, 256);
}

} // namespace keyhole
