#include "photonmap/map_stores.h"

#include <algorithm>

namespace keyhole {

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

std::size_t MapStores::bytes() const {
    return pilots_.global.bytes() + pilots_.caustic.bytes() + main_photons_.global.bytes() +
           main_photons_.caustic.bytes();
}

std::size_t photons_for_caustic(double share, std::size_t photons) {
    return static_cast<std::size_t>(std::clamp(share, 0.02, 0.98) * static_cast<double>(photons));
}

std::int64_t round_length(std::int64_t photons, std::int64_t chains) {
    return std::clamp<std::int64_t>(photons / (32 * chains), 2, 256);
}

} // namespace keyhole
