// Importons: the importance that eye paths bring to the surfaces where photon maps are asked.
#pragma once

#include "core/progress.h"
#include "photonmap/photon.h"
#include "sampling/paths/image_weight.h"
#include "scene/scene.h"

#include <cstdint>
#include <tuple>
#include <vector>

namespace keyhole {

struct ImportanceTracing {
    std::int64_t samples; ///< eye paths
    bool at_d1 = true;    ///< whether importons at the first non-specular vertex are wanted as well
    int max_scatterings = 24;
    std::uint64_t seed;
    const ImageWeight* weight = nullptr; ///< of pixels; null: 1 everywhere
};

/// Importons, the adjoint of photons: `power` is RGB throughput from a window of density 1, over the number of eye
/// paths, so that a sum over importons is an integral over camera sub-paths, times the weight of its pixel; `direction`
/// leads towards the camera sub-path; `caustic` are those that specular vertices brought.
struct Importons {
    std::vector<Photon> first;  ///< at d1
    std::vector<Photon> second; ///< at d2

    auto parts() { return std::tie(first, second); }
};

/// Traces eye paths as far as their second non-specular vertex. Takes no more memory than the result, and a little.
/// Reproducible on any number of threads.
Importons trace_importance(const Scene& scene, const ImportanceTracing& options, const RunContext& context);

} // namespace keyhole
