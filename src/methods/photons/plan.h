// What a scene needs of the methods that render from photon maps, and what is left out.
#pragma once

#include "core/progress.h"
#include "core/statistics.h"
#include "methods/photons/photon_sampler.h"
#include "sampling/paths/path.h"
#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
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

/// One choice.
struct PlanItem {
    std::string name;
    bool on;
    std::string why;
};

struct RenderPlan {
    SceneSurvey survey;
    bool photons = true;                    ///< photon maps, importance maps, chains
    bool caustics = true;                   ///< a caustic map, importance and proposals for it
    bool gather = true;                     ///< gather rays for indirect light, more than one for each visible point
    bool cache = true;                      ///< of irradiance
    std::optional<GatherCoverage> coverage; ///< of gather rays; none: final gather can do all
    std::vector<PlanItem> items;
};

/// Decides what is left out, by what the materials can do, and by light that the eye can't see: photons are given up
/// only if neither paths from the eye, nor paths from both ends find any light that photon maps would hold, and light
/// paths come nowhere near what eye paths reach. With settings.plan = all everything is on.
/// Light outside the coverage of gather rays goes to a map of its own if there is more than a little.
/// @param survey_samples paths that the survey traces.
RenderPlan plan_render(const SamplerContext& c, const RunContext& run, std::int64_t survey_samples = 4096);

} // namespace keyhole
