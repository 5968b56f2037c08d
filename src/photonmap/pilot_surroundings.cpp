#include "photonmap/pilot_surroundings.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

constexpr unsigned kSteps = 255, kPartlyOccluded = 256;

/// The four bits above: nothing stands within max_radius / 2^(level - 1); 0: within no such distance that is known.
constexpr unsigned kLevelShift = 9, kMostLevel = 15;

/// Of a pilot photon's radius, how far it looks for what may stand around: lookups of about its radius reach so far.
constexpr float kClear = 1.5f;

/// Steps to which radii are known, in each of which they are by 0.07 % less, and the last of them.
constexpr float kRadiusSteps = 1024, kLeastRadius = 65534;

float clear_distance(unsigned packed, float max_radius) {
    const unsigned level = packed >> kLevelShift;
    return level == 0 ? 0 : std::ldexp(max_radius, 1 - static_cast<int>(level));
}

} // namespace

PilotSurroundings::PilotSurroundings(const PilotedMap& map, const SurfacePatches& patches, int k, float max_radius,
                                     float shrink)
    : pilots_(map.pilots()), main_photons_(map.main_photons()), patches_(patches), k_(k), max_radius_(max_radius),
      shrink_(shrink), known_(pilots_.photons().size()), radii_(main_photons_.photons().size()) {}

float PilotSurroundings::radius(const Photon& photon) const {
    std::atomic<std::uint16_t>& known = radii_[static_cast<std::size_t>(&photon - main_photons_.photons().data())];
    std::uint16_t code = known.load(std::memory_order_relaxed);
    if (code == 0) {
        const SurfaceRegion region{photon.position(), photon.normal().decode()};
        const float r = piloted_radius(pilots_, {region, max_radius_, k_, shrink_});
        const float steps = std::min(kRadiusSteps * std::log2(max_radius_ / r), kLeastRadius);
        known.store(code = static_cast<std::uint16_t>(1 + std::lround(steps)), std::memory_order_relaxed);
    }
    return max_radius_ * std::exp2(static_cast<float>(1 - code) / kRadiusSteps);
}

bool PilotSurroundings::partly_occluded(const SurfaceRegion& region, const PilotedRegion& piloted) const {
    const auto packed = known_around(region, piloted);
    return packed ? (*packed & kPartlyOccluded) != 0 : own(region, piloted.radius).partly_occluded;
}

Surroundings PilotSurroundings::around(const SurfaceRegion& region, const PilotedRegion& piloted) const {
    const float r = piloted.radius;
    const auto packed = known_around(region, piloted);
    if (!packed) return own(region, r);
    const unsigned steps = *packed & kSteps;
    const bool partly_occluded = (*packed & kPartlyOccluded) != 0;
    if (!partly_occluded && steps < kSteps) return {patches_.area(region, r), false};
    return {kPi * static_cast<double>(r) * r * steps / kSteps, partly_occluded};
}

std::optional<PilotSurroundings::Packed> PilotSurroundings::known_around(const SurfaceRegion& region,
                                                                         const PilotedRegion& piloted) const {
    if (!piloted.nearest) return std::nullopt;
    const Packed packed = at(*piloted.nearest);
    const float distance = (pilots_[*piloted.nearest].position() - region.position).length();
    const bool clear = distance + piloted.radius <= clear_distance(packed, max_radius_);
    return clear || (packed & kPartlyOccluded) != 0 ? std::optional(packed) : std::nullopt;
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
    if (around.partly_occluded) return static_cast<Packed>(steps | kPartlyOccluded);
    // The smallest of the distances that is far enough.
    const auto level = static_cast<unsigned>(
        std::clamp(std::log2(max_radius_ / (kClear * r)) + 1, 1.0f, static_cast<float>(kMostLevel)));
    const bool clear = !patches_.obstructed(region, std::ldexp(max_radius_, 1 - static_cast<int>(level)));
    return static_cast<Packed>(steps | (clear ? level << kLevelShift : 0));
}

Surroundings PilotSurroundings::own(const SurfaceRegion& region, float r) const {
    return surroundings_of(patches_, region, r, patches_.obstructed(region, r));
}

} // namespace keyhole
