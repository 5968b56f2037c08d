// Where light and importance come to: the places that an edge of a path may join.
#pragma once

#include "core/progress.h"
#include "scene/scene.h"

#include <cstdint>
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

} // namespace keyhole
