#include "photonmap/pilot_surroundings.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

constexpr unsigned kSteps = 255, kParted = 256;

} // namespace

PilotSurroundings::PilotSurroundings(const PhotonMap& pilots, const SurfacePatches& patches, int k, float max_radius,
                                     float shrink)
    : pilots_(pilots), patches_(patches), k_(k), max_radius_(max_radius), shrink_(shrink),
      known_(pilots.photons().size()) {}

bool PilotSurroundings::parted(const SurfaceRegion& region, const PilotedRegion& piloted) const {
    return piloted.nearest ? (at(*piloted.nearest) & kParted) != 0 : own(region, piloted.radius).parted;
}

Surroundings PilotSurroundings::around(const SurfaceRegion& region, const PilotedRegion& piloted) const {
    const float r = piloted.radius;
    if (!piloted.nearest) return own(region, r);
    const unsigned packed = at(*piloted.nearest), steps = packed & kSteps;
    const bool parted = (packed & kParted) != 0;
    if (!parted && steps < kSteps) return {patches_.area(region, r), false};
    return {kPi * static_cast<double>(r) * r * steps / kSteps, parted};
}

PilotSurroundings::Packed PilotSurroundings::at(std::uint32_t pilot) const {
    std::atomic<Packed>& known = known_[pilot];
    Packed packed = known.load(std::memory_order_relaxed);
    if (packed == 0) known.store(packed = measure(pilots_[pilot]), std::memory_order_relaxed);
    return packed;
}

PilotSurroundings::Packed PilotSurroundings::measure(const Photon& pilot) const {
    const SurfaceRegion region{pilot.position(), pilot.normal().decode()};
    const float r = piloted_radius(pilots_, {region, max_radius_, k_, shrink_}, 1);
    if (!(r > 0)) return kSteps; // pilot photons on one spot
    const Surroundings around = own(region, r);
    const double share = around.area / (kPi * static_cast<double>(r) * r);
    // At least one step: a pilot photon lies on some surface, and 0 says that nobody asked.
    const auto steps = static_cast<unsigned>(std::lround(kSteps * std::clamp(share, 1.0 / kSteps, 1.0)));
    return static_cast<Packed>(steps | (around.parted ? kParted : 0));
}

Surroundings PilotSurroundings::own(const SurfaceRegion& region, float r) const {
    return surroundings_of(patches_, region, r, patches_.obstructed(region, r));
}

} // namespace keyhole
