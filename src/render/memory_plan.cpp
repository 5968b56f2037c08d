#include "render/memory_plan.h"

#include "photonmap/photon_store.h"

#include <algorithm>

namespace keyhole {
namespace {

// Bytes. An index takes 8 to 9 on top of a photon's 24, by how its places cluster.
constexpr double kFixed = 64 * 1024; // first blocks of small indices
constexpr double kIndexed = sizeof(Photon) + 10.0;
constexpr double kInStageThree = kIndexed + (kIndexed + 16) / 4;         // irradiance and direct light at every fourth
constexpr double kInStageTwo = PhotonStore::bytes_per_photon() * 1.0625; // buffers on their way to the stores

} // namespace

MemoryPlan plan_memory(const Settings& settings, ImportanceUse use, int maps) {
    const double memory = std::max(static_cast<double>(settings.photon_memory) - kFixed, kFixed);
    // Importance that stays beside the photons decides how good their power is: half of what is left for it.
    double photons = memory / (use == ImportanceUse::beside ? 2 * kInStageThree : kInStageThree);
    if (settings.photons > 0) photons = std::min(photons, static_cast<double>(settings.photons));
    double importons = 0;
    if (use == ImportanceUse::beside) importons = (memory - photons * kInStageTwo) / (kIndexed * maps);
    // All importons, and the index and the estimates of one map; later the estimates of all, beside the stores.
    if (use == ImportanceUse::guide)
        importons = std::min(memory / (sizeof(Photon) * maps + 10.0 + kIndexed / 4),
                             (memory - photons * kInStageTwo) / (kIndexed / 4 * maps));
    return {static_cast<std::size_t>(photons),
            std::clamp<std::int64_t>(static_cast<std::int64_t>(importons), 1, settings.importons)};
}

} // namespace keyhole
