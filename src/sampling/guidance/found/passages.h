// Where light and importance come to, and narrow lines of sight between what is lit and what matters to the eye.
#pragma once

#include "core/progress.h"
#include "scene/scene.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace keyhole {

/// A place on a surface that a path from either end of the transport has come to.
struct TransportEnd {
    SurfacePoint point;
    Vec3 n;             ///< unit geometric normal, on the side where the path goes on
    double weight;      ///< luminance: power that arrives there [W], or importance of the window
    SurfacePoint x0{};  ///< of the light path, on its emitter; nothing where the path comes from the eye
    bool emits = false; ///< the place is x0 itself
};

struct TransportEnds {
    std::vector<TransportEnd> light; ///< emitters of the scene that have a place, and what they shine on
    std::vector<TransportEnd> eye;   ///< what the eye sees, and what is seen from there
};

/// Traces so many paths from either end. The same on any number of threads. @throws Interrupted
TransportEnds trace_transport_ends(const Scene& scene, std::int64_t paths, std::uint64_t seed,
                                   const RunContext& context);

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
