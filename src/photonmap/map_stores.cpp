#include "photonmap/map_stores.h"

#include <algorithm>

namespace keyhole {

MapStores::Pair MapStores::make_pair(std::size_t global, std::size_t caustic, const Thresholds& initial,
                                     std::uint64_t seed, PhotonRole role) {
    const auto share = [&](std::size_t ceiling) {
        const std::size_t scouts = ceiling / kScoutEvery;
        return role == PhotonRole::scout ? scouts : ceiling - scouts;
    };
    const std::uint64_t stream = 2 * static_cast<std::uint64_t>(role);
    return {PhotonStore(share(global), initial.global, Rng(seed, StreamPurpose::thinning, stream)),
            PhotonStore(share(caustic), initial.caustic, Rng(seed, StreamPurpose::thinning, stream + 1))};
}

MapStores::MapStores(std::size_t global, std::size_t caustic, const Thresholds& initial, std::uint64_t seed)
    : scouts_(make_pair(global, caustic, initial, seed, PhotonRole::scout)),
      carriers_(make_pair(global, caustic, initial, seed, PhotonRole::carrier)) {}

void MapStores::absorb(PhotonRole role, MapBuffers& buffers) {
    of(role).global.absorb(buffers.global);
    of(role).caustic.absorb(buffers.caustic);
}

MapStores::Thresholds MapStores::thresholds(PhotonRole role) const {
    const Pair& pair = role == PhotonRole::scout ? scouts_ : carriers_;
    return {pair.global.threshold(), pair.caustic.threshold()};
}

Photons MapStores::release(double global_scale, double caustic_scale) {
    return {{scouts_.global.release(1), carriers_.global.release(global_scale)},
            {scouts_.caustic.release(1), carriers_.caustic.release(caustic_scale)}};
}

std::size_t MapStores::bytes() const {
    return scouts_.global.bytes() + scouts_.caustic.bytes() + carriers_.global.bytes() + carriers_.caustic.bytes();
}

std::size_t photons_for_caustic(double share, std::size_t photons) {
    return static_cast<std::size_t>(std::clamp(share, 0.02, 0.98) * static_cast<double>(photons));
}

std::int64_t round_length(std::int64_t photons, std::int64_t chains) {
    return std::clamp<std::int64_t>(photons / (32 * chains), 2, 256);
}

} // namespace keyhole
