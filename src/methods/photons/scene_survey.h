// What the eye sees of a scene's light and surfaces, by a few independent paths.
#pragma once

#include "core/progress.h"
#include "core/statistics.h"
#include "sampling/paths/path_class.h"
#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace keyhole {

/// Shares of what is visible through the window. Reproducible on any number of threads.
struct SceneSurvey {
    std::int64_t samples = 0; ///< eye paths that were traced
    /// Mean luminance over the window [W/(m^2 sr)] that light of each LightClass makes.
    std::array<RunningStats, 5> light;
    /// Mean luminance that light from each emitter makes, direct or not; by the emitter's index.
    std::vector<double> by_emitter;
    /// Shares of the window where the first surface is of a kind: with a delta part, with a finite part that no cache
    /// serves (glossy; where there is a diffuse part as well, by its share in what they reflect), with a diffuse part;
    /// they may add up to more than 1. `nothing`: no surface.
    double specular = 0, glossy = 0, diffuse = 0, nothing = 0;

    const RunningStats& of(LightClass c) const { return light[static_cast<std::size_t>(c)]; }
    double total() const;
    /// Luminance of what photon maps would hold.
    double stored() const { return of(LightClass::caustic).mean() + of(LightClass::indirect).mean(); }
};

/// Traces `samples` paths from the eye with next-event estimation. @throws Interrupted
SceneSurvey survey_scene(const Scene& scene, std::int64_t samples, int max_scatterings, std::uint64_t seed,
                         const RunContext& context = {});

} // namespace keyhole
