// What a sampler leaves: photons of two maps, each in two roles.
#pragma once

#include "photonmap/photon.h"

#include <cstdint>
#include <vector>

namespace keyhole {

/// Pilot photons decide where light is estimated and over what region; main photons bring the light that is counted
/// there. The two come from independent paths. Were a region to end at the k-th of the photons that are counted, their
/// clumps (a chain stays where it is, or near) would pull estimates up: the mean of 1 / A_k is right for photons that
/// know nothing of each other alone. Given the pilot photons, an estimate is linear in the main photons, and so has the
/// right expectation however they hang together.
enum class PhotonRole : std::uint8_t { pilot, main_photon };

/// One light path or chain in so many is a pilot photon.
constexpr int kPilotEvery = 4;
inline PhotonRole role_of_sample(std::int64_t i) {
    return i % kPilotEvery == kPilotEvery - 1 ? PhotonRole::pilot : PhotonRole::main_photon;
}

struct PhotonSet {
    std::vector<Photon> pilots;       ///< power means nothing
    std::vector<Photon> main_photons; ///< power [W]

    std::size_t size() const { return pilots.size() + main_photons.size(); }
};

struct Photons {
    PhotonSet global, caustic;
};

} // namespace keyhole
