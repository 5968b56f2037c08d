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

/// A plan that stays under settings.photon_memory: before stage three importance maps and stores, in stage three the
/// maps with their indices and precomputed irradiance. `maps` importance maps are made (1 or 2).
MemoryPlan plan_memory(const Settings& settings, ImportanceUse use, int maps);

} // namespace keyhole
