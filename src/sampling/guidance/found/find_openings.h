// User paths that the renderer finds itself: through the openings that light has to pass.
#pragma once

#include "sampling/guidance/found/passages.h"
#include "sampling/guidance/learned/learned_emission.h"
#include "scene/load/yaml/user_path_file.h"
#include "scene/scene.h"

#include <limits>
#include <vector>

namespace keyhole {

struct OpeningSearch {
    std::int64_t pairs = std::int64_t{1} << 20;               ///< of ends that are tried at most
    double seconds = std::numeric_limits<double>::infinity(); ///< for these, about
    int max_scatterings = 24;                                 ///< of light, on its way through an opening
    std::size_t most = 4;                                     ///< openings
    double least_gain = 1.5;                  ///< as gain_by_guides(), with which paths are worth having
    std::vector<Opening> known{};             ///< that light is led through already: passages through them don't count
    const LearnedEmission* learned = nullptr; ///< where light paths would begin else; null: by power
    std::uint64_t seed = 1;
};

/// What the paths of a file lead through.
std::vector<Opening> openings_of(const UserPathFile& file);

struct OpeningsFound {
    UserPathFile paths; ///< none where there are none that bring anything
    int openings = 0;   ///< that they lead through
    double gain = 1;    ///< by how much fewer light paths do as well
};

/// Paths from the emitters through openings: rectangles that narrow lines of sight between lit places and places that
/// matter to the eye lead through. For each opening and emitter one for each number of bounces, the straight one among
/// them where light takes it. None through what is known, and none where light comes from infinity only. Each works: it
/// was bound to the scene. The same on any number of threads. @throws Interrupted
OpeningsFound find_openings(const Scene& scene, const TransportEnds& ends, const OpeningSearch& search,
                            const RunContext& context);

} // namespace keyhole
