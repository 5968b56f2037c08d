// Shadow rays that find out where direct light comes from.
#pragma once

#include "core/progress.h"
#include "sampling/guidance/learned/learned_direct_light.h"

#include <cstdint>
#include <limits>
#include <memory>

namespace keyhole {

/// What learning takes.
struct DirectLightLearning {
    std::int64_t paths;                                       ///< from the eye, at most, whose vertices are asked
    double seconds = std::numeric_limits<double>::infinity(); ///< of the time until the stop, about
    int max_scatterings = 24;                                 ///< of a path
    std::uint64_t seed = 1;
    std::size_t most_bytes = 16 << 20; ///< of what is learned
};

/// Whether there is a choice to be learned: of three emitters or more, or of directions to an environment.
bool has_choice_of_direct_light(const Scene& scene);

/// Learned in rounds, each of twice as many paths as the one before and by what that has learned. No sample of them
/// counts in any picture. The same on any number of threads, unless `seconds` ends it. Null where it wouldn't pay.
/// @throws Interrupted
std::shared_ptr<const LearnedDirectLight> learn_direct_light(const Scene& scene, const DirectLightLearning& learning,
                                                             const RunContext& context);

} // namespace keyhole
