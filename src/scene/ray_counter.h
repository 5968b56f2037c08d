// How many rays were traced.
#pragma once

#include <cstdint>

namespace keyhole {

/// Counts a ray of the calling thread; costs an increment.
void count_ray();

/// Rays traced by all threads since the program began. Exact while no thread traces.
std::uint64_t rays_traced();

} // namespace keyhole
