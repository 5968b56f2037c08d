// What a scene needs of the methods that render from photon maps, and what is left out.
#pragma once

#include "core/progress.h"
#include "methods/photons/photon_sampler.h"
#include "methods/photons/scene_survey.h"

#include <optional>
#include <string>
#include <vector>

namespace keyhole {

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
