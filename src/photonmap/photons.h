// What a sampler leaves: photons of two maps, each in two roles.
#pragma once

#include "photonmap/photon.h"

#include <cstdint>
#include <vector>

namespace keyhole {

/// Scouts decide where light is estimated and over what region; carriers bring the light that is counted there. The two
/// come from independent paths. Were a region to end at the k-th of the photons that are counted, their clumps (a chain
/// stays where it is, or near) would pull estimates up: the mean of 1 / A_k is right for photons that know nothing of
/// each other alone. Given the scouts, an estimate is linear in the carriers, and so has the right expectation however
/// they hang together.
enum class PhotonRole : std::uint8_t { scout, carrier };

/// One light path or chain in so many is a scout.
constexpr int kScoutEvery = 4;
inline PhotonRole role_of_sample(std::int64_t i) {
    return i % kScoutEvery == kScoutEvery - 1 ? PhotonRole::scout : PhotonRole::carrier;
}

struct PhotonSet {
    std::vector<Photon> scouts;   ///< power means nothing
    std::vector<Photon> carriers; ///< power [W]

    std::size_t size() const { return scouts.size() + carriers.size(); }
};

struct Photons {
    PhotonSet global, caustic;
};

} // namespace keyhole
