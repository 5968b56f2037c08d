// User paths found by the renderer itself: paths that carry much and are hard to find, by resampling.
#pragma once

#include "sampling/brightness.h"
#include "scene/load/yaml/user_path_file.h"

namespace keyhole {

struct SuggestOptions {
    std::size_t count = 10;   ///< most paths to suggest
    std::int64_t pool = 4000; ///< paths of stage one to choose from
    double radius = 0.08; ///< paths whose vertices all lie nearer than this are alike, as a share of the scene's size
};

/// Paths that are drawn in proportion to contribution from stage one are weighted once more, by contribution over the
/// density with which bidirectional tracing makes them: bright and hard. Those whose light sub-paths are alike make
/// one suggestion, whose weight is their sum and whose cones are as wide as they spread. Hardest first; fewer than
/// asked for where there are no more, none where no light was found. Each works: it was checked in the scene.
UserPathFile suggest_user_paths(const Scene& scene, const StageOneSettings& first, const SuggestOptions& options);

} // namespace keyhole
