// The opening that passages lead through: the plane of what surrounds it, and a rectangle there.
#pragma once

#include "sampling/guidance/found/passages.h"
#include "scene/load/yaml/user_path_file.h"

#include <optional>
#include <span>

namespace keyhole {

/// An opening, and which passages lead through it.
struct FoundOpening {
    Opening opening;
    std::vector<Passage> passages; ///< at least one
};

/// The opening that most of `passages` share, which are taken out of them. Its plane is that in which most of their
/// blockers lie; how far it goes is asked by rays from the ends on the light's side. None where no two share one.
std::optional<FoundOpening> take_opening(const Scene& scene, std::vector<Passage>& passages);

} // namespace keyhole
