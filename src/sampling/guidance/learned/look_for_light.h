// Paths from the eye to lights, from which light paths learn where they are wanted. They count in no picture.
#pragma once

#include "core/progress.h"
#include "sampling/guidance/learned/learned_scattering.h"
#include "sampling/paths/path_set.h"
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace keyhole {

struct LightSearch {
    std::int64_t paths;  ///< from the eye
    int max_scatterings; ///< of a path
    PathSet set{};       ///< what photons are stored for
    std::uint64_t seed = 1;
    std::size_t most_bytes = 16 << 20;
};

/// The end at an emitter of a path whose light is for photon maps.
struct SeenLight {
    std::uint32_t emitter;
    SurfaceCells::Place at; ///< where its light first arrives; the normal on the side that it comes from
    Vec3 towards;           ///< unit, where it comes from
    double weight;          ///< luminance in the picture
};

struct FoundLightPaths {
    std::vector<SeenLight> ends;
    std::vector<SeenScattering> scatterings; ///< one of each path, if it has any
};

/// @throws Interrupted
FoundLightPaths look_for_light(const Scene& scene, const LightSearch& search, const RunContext& context);

} // namespace keyhole
