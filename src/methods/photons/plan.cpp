#include "methods/photons/plan.h"

#include "core/percent.h"
#include "methods/method.h"
#include "methods/photons/find_coverage.h"
#include "methods/photons/trials/light_trial.h"

namespace keyhole {
namespace {

/// Whether anything at all finds light that photon maps would hold.
PlanItem plan_photons(const SamplerContext& c, const SceneSurvey& survey, const RunContext& run) {
    const char* name = "photon maps";
    if (!c.settings.load_map.empty()) return {name, true, "they come from a file"};
    if (c.scene.emitter_distribution().empty()) return {name, false, "nothing emits light"};
    if (c.scene.has_scattering_media()) return {name, false, "a medium scatters, and photons lie on surfaces"};
    if (survey.stored() > 0)
        return {name, true, percent(survey.stored() / survey.total()) + " of the light that is seen would be in them"};
    // What paths from the eye meet by chance only may be easy to find from both ends, or from the light.
    if (may_be_lit(c, run)) return {name, true, "light comes near what the eye sees, and may find a way there"};
    return {name, false, "no indirect light reaches the eye: neither paths from the eye nor from the light found any"};
}

PlanItem plan_caustics(const Scene& scene) {
    const char* name = "caustic map and proposals";
    return scene.traits().delta ? PlanItem{name, true, "there are mirrors or smooth glass"}
                                : PlanItem{name, false, "nothing in the scene is specular"};
}

PlanItem plan_coverage(const Settings& settings, bool photons, const CoverageFound& found) {
    const char* name = "light beyond gather rays";
    if (!settings.gather_coverage) return {name, false, "the setting gather_coverage is off"};
    if (!photons) return {name, false, "no photon maps"};
    if (settings.method->stores_everywhere()) return {name, false, "standard photon mapping gathers all light"};
    return {
        name, found.coverage.has_value(),
        percent(found.beyond) + " of the light arrives where few gather rays do" +
            (found.coverage ? ": it is stored where it is seen" : ": enough of them to gather it without much noise")};
}

PlanItem plan_gather(const Scene& scene, bool photons, const SceneSurvey& survey) {
    const char* name = "gather rays";
    if (scene.has_scattering_media()) return {name, false, "a medium scatters: paths are traced"};
    if (photons) return {name, true, "they ask the photon maps"};
    return survey.of(LightClass::second).mean() > 0
               ? PlanItem{name, true, "light that was scattered once before the last surface is sampled along them"}
               : PlanItem{name, false, "there is no indirect light to gather; one ray a point helps with direct light"};
}

PlanItem plan_cache(const Scene& scene, const Settings& settings, bool gather) {
    const char* name = "irradiance cache";
    if (!settings.irradiance_cache) return {name, false, "the setting irradiance_cache is off"};
    if (!gather) return {name, false, "there is no indirect light to cache"};
    return scene.traits().diffuse ? PlanItem{name, true, "there are diffuse surfaces"}
                                  : PlanItem{name, false, "no surface is diffuse"};
}

} // namespace

RenderPlan plan_render(const SamplerContext& c, const RunContext& run, std::int64_t survey_samples) {
    const Settings& s = c.settings;
    RenderPlan plan;
    plan.survey =
        survey_scene(c.scene, survey_samples, static_cast<int>(s.max_depth), static_cast<std::uint64_t>(s.seed), run);
    const auto add = [&](PlanItem item) {
        if (!item.on && s.plan == Plan::all) item = {item.name, true, item.why + ", but the setting plan asks for all"};
        plan.items.push_back(std::move(item));
        return plan.items.back().on;
    };
    plan.photons = add(plan_photons(c, plan.survey, run));
    plan.caustics =
        add(plan.photons ? plan_caustics(c.scene) : PlanItem{"caustic map and proposals", false, "no photon maps"});
    CoverageFound found;
    if (plan.photons) found = find_coverage(c.scene, s, run);
    add(plan_coverage(s, plan.photons, found));
    plan.coverage = std::move(found.coverage);
    plan.gather = add(plan_gather(c.scene, plan.photons, plan.survey));
    plan.cache = add(plan_cache(c.scene, s, plan.gather)) && s.irradiance_cache;
    return plan;
}

} // namespace keyhole
