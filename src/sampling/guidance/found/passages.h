// Narrow lines of sight between what is lit and what matters to the eye.
#pragma once

#include "sampling/guidance/found/transport_ends.h"

#include <limits>

namespace keyhole {

/// A place on a surface that hides what is behind it.
struct Blocker {
    Vec3 p, n; ///< world space; unit geometric normal
};

/// A free line of sight around which most others are blocked.
struct Passage {
    TransportEnd light, eye;
    std::vector<Blocker> blockers; ///< what rays beside it meet
};

struct PassageSearch {
    std::int64_t pairs = std::int64_t{1} << 20;               ///< of ends that are tried at most
    double seconds = std::numeric_limits<double>::infinity(); ///< of the time until the stop, about
    std::size_t enough = 64;                                  ///< passages
    std::uint64_t seed = 1;
};

/// Whether what is lit lies open to the eye: so many pairs of ends see each other that light needs no help.
/// @throws Interrupted
bool light_finds_its_way(const Scene& scene, const TransportEnds& ends, std::uint64_t seed, const RunContext& context);

/// Tries pairs of ends by their weights: whether they see each other, and if so whether neighbouring lines pass as
/// well. The same on any number of threads. @throws Interrupted
std::vector<Passage> find_passages(const Scene& scene, const TransportEnds& ends, const PassageSearch& search,
                                   const RunContext& context);

} // namespace keyhole
