// What a sampler leaves: photons of two maps, each in two roles; and who watches them being made.
#pragma once

#include "photonmap/photon.h"

#include <cstddef>
#include <cstdint>
#include <span>
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
    /// Whether they lie wherever light comes; otherwise only where paths of the sampler store them, which is where
    /// gather rays of visible points end.
    bool everywhere = false;
};

/// A vertex of a light path, as far as it is drawn.
struct TrailPoint {
    Vec3 p;                ///< world space; of an infinite emitter the unit direction towards it
    bool specular = false; ///< whether light is scattered here by a specular event
    bool infinite = false;

    bool operator==(const TrailPoint&) const = default;
};

/// How light came to a photon.
struct PhotonOrigin {
    std::span<const TrailPoint> trail; ///< from the emitter on; as far as the eye where the sampler has whole paths
    std::size_t photon;                ///< which of them the photon lies at; light was scattered once less before
    std::uint32_t emitter;
    bool guided; ///< whether the path began along a user path
};

/// The functions are called by many threads at once, in no order.
class PhotonObserver {
  public:
    virtual ~PhotonObserver() = default;
    /// Waits for a store, which may thin it out later. Power is only told by the map.
    virtual void stored(const Photon& photon, const PhotonOrigin& origin) = 0;
    /// Light arrived at `p`, and did not survive the roulette of the stores.
    virtual void thrown_away(const Vec3& p) = 0;
};

} // namespace keyhole
