#include "methods/photons/memory_plan.h"

#include "gather/direct_irradiance_cache.h"
#include "photonmap/irradiance/irradiance_map.h"
#include "photonmap/map_stores.h"

#include <algorithm>

namespace keyhole {
namespace {

// Bytes.
constexpr double kFixed = 64 * 1024; // what small maps round up
const double kIndexed = sizeof(Photon) + PhotonMap::index_bytes_per_photon(PhotonMap::Wanted::many);
const double kPilotPhoton = sizeof(Photon) + PhotonMap::index_bytes_per_photon(PhotonMap::Wanted::one);
constexpr double kList = sizeof(std::uint32_t); // while an index is built; later places are as large
constexpr double kInStageTwo = PhotonStore::bytes_per_photon() * 1.0625; // buffers on their way to the stores

/// For lookups without a search, by place, where there is room: with 6 every second one may have to search.
constexpr std::size_t kForLookups = 24;
/// The memory over what photons take, from which on there is.
constexpr double kRoom = 1.5;

/// A chain leaves its state and its candidate.
constexpr double kPhotonsOfStep = 2;

/// Longest paths, in scatterings, whose last ones count: with an albedo of 0.8 those after this bring half a percent.
constexpr std::int64_t kLongPath = 24;

/// What each pilot photon of a map takes with the irradiance there, without direct light.
double of_place(const Settings& settings) {
    return kPilotPhoton + static_cast<double>(IrradianceMap::bytes_per_place(length_matters(settings)));
}

/// What each photon of a map takes in stage three, with its part of a pilot photon and of all that is known there.
double in_stage_three(const Settings& settings) {
    return ((kPilotEvery - 1) * kIndexed + of_place(settings) + DirectIrradianceCache::bytes_per_place()) / kPilotEvery;
}

double memory_for_maps(const Settings& settings) {
    return std::max(static_cast<double>(settings.photon_memory) - kFixed, kFixed);
}

} // namespace

bool length_matters(const Settings& settings) { return settings.max_depth <= kLongPath; }

MemoryPlan plan_memory(const Settings& settings, ImportanceUse use, int maps) {
    const double memory = memory_for_maps(settings), of_photon = in_stage_three(settings);
    const bool stays = use == ImportanceUse::beside || use == ImportanceUse::both;
    // Importance that stays beside the photons decides how good their power is: half of what is left for it.
    double photons = memory / (stays ? 2 * of_photon : of_photon);
    if (settings.photons > 0) photons = std::min(photons, static_cast<double>(settings.photons));
    double importons = 0;
    const double places = of_place(settings) / kPilotEvery;
    const double each = kIndexed + (use == ImportanceUse::both ? places : 0);
    if (stays) importons = (memory - photons * kInStageTwo) / (each * maps);
    // All importons, and the index and the places of one map; later the places of all, beside the stores.
    if (use == ImportanceUse::guide)
        importons = std::min(memory / (sizeof(Photon) * (maps - 1) + kIndexed + kList + places),
                             (memory - photons * kInStageTwo) / (places * maps));
    return {static_cast<std::size_t>(photons),
            std::clamp<std::int64_t>(static_cast<std::int64_t>(importons), 1, settings.importons)};
}

std::uint64_t most_photon_bytes(const Settings& settings, ImportanceUse use, int maps) {
    const auto memory = static_cast<double>(settings.photon_memory);
    const bool chains = use == ImportanceUse::beside || use == ImportanceUse::both;
    double photons = 0;
    if (use != ImportanceUse::beside) photons += static_cast<double>(settings.light_paths * settings.max_depth);
    if (chains) photons += kPhotonsOfStep * static_cast<double>(settings.mutations);
    const MemoryPlan plan = plan_memory(settings, use, maps);
    photons = std::min(photons, static_cast<double>(plan.photons));
    const double importons = use == ImportanceUse::none ? 0 : static_cast<double>(plan.importons) * maps;
    const double places = of_place(settings) / kPilotEvery, lookups = static_cast<double>(kForLookups) / kPilotEvery;
    return static_cast<std::uint64_t>(std::min(memory, 2 * kFixed + photons * (in_stage_three(settings) + lookups) +
                                                           importons * (kIndexed + kList + places)));
}

std::size_t memory_for_lookups(const Settings& settings, std::size_t photons, std::size_t places) {
    const bool room = kRoom * static_cast<double>(photons) * in_stage_three(settings) < memory_for_maps(settings);
    return room ? kForLookups * places : 0;
}

} // namespace keyhole
