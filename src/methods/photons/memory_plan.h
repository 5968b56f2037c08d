// How the memory that the user gave is shared out among photons, their index and the importance maps.
#pragma once

#include "methods/method.h"

#include <cstddef>
#include <cstdint>

namespace keyhole {

struct MemoryPlan {
    std::size_t photons;    ///< most of both maps together
    std::int64_t importons; ///< eye paths traced, each with at most one importon in each importance map
};

/// Whether max_depth is so small that it matters how long the way to the eye is from where photons are: light that has
/// been scattered as often as that is too little otherwise.
bool length_matters(const Settings& settings);

/// A plan that stays under settings.photon_memory: before stage three importance maps and stores, in stage three the
/// maps with their indices and precomputed irradiance. `maps` importance maps are made (1 or 2).
MemoryPlan plan_memory(const Settings& settings, ImportanceUse use, int maps);

/// What photons and all that serves them can take at most [bytes]: settings.photon_memory, or less where the work that
/// the settings ask for can't leave so many.
std::uint64_t most_photon_bytes(const Settings& settings, ImportanceUse use, int maps);

/// Memory for lookups of precomputed irradiance without a search [bytes], where maps hold so many photons in all and
/// irradiance is estimated at `places`; 0, no more than is planned, where photons take most of settings.photon_memory.
std::size_t memory_for_lookups(const Settings& settings, std::size_t photons, std::size_t places);

} // namespace keyhole
