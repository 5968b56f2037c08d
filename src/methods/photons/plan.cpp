#include "methods/photons/plan.h"

#include "core/percent.h"
#include "core/shared_work.h"
#include "methods/method.h"
#include "methods/photons/find_coverage.h"
#include "methods/photons/photon_sampler.h"
#include "methods/photons/radii.h"
#include "photonmap/importance/importance_map.h"
#include "photonmap/importance/importance_tracing.h"
#include "sampling/brightness.h"
#include "sampling/guidance/guided_light.h"
#include "sampling/paths/image_lattice.h"
#include "sampling/paths/path_tracer.h"
#include "session/passes.h"

#include <algorithm>
#include <atomic>

namespace keyhole {
namespace {

constexpr std::int64_t kPathsOfBlock = 64; // light paths

/// How much is tried where a survey by eye paths met no light to store: less where the render itself will be short.
struct Extent {
    std::int64_t importons, light_paths, brightness_samples;

    explicit Extent(const Settings& s) {
        const std::int64_t work = std::min<std::int64_t>(std::max(s.light_paths, s.mutations), 500'000);
        const auto part = [&](std::int64_t most) { return std::max(most * work / 500'000, most / 8); };
        importons = part(50'000);
        light_paths = part(32'768);
        brightness_samples = part(32'768);
    }
};

/// Whether a light path left a photon where importons are.
struct VisiblePower {
    const ImportanceGuide& global;
    const ImportanceGuide& caustic;
    StorageRule rule;
    bool found = false;

    bool arrival(Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast& past) {
        if (!v.bsdf.traits().finite) return true;
        const StorageRule::Kinds kinds = rule(v, to_light, past);
        found |= kinds.global && global.visible_power(v, to_light, power).value_or(0) > 0;
        found |= kinds.caustic && caustic.visible_power(v, to_light, power).value_or(0) > 0;
        return !found;
    }
};

/// As if no wall stood between photons and importons.
bool light_comes_near(const SamplerContext& c, const Extent& extent, const RunContext& run) {
    const auto depth = static_cast<int>(c.settings.max_depth);
    const std::uint64_t seed = seed_of_trial(c.settings);
    Importons importons = trace_importance(c.scene, c.importance_tracing(extent.importons, seed), run);
    const float radius = Radii(c.scene).importance;
    const ImportanceGuide global(PhotonMap(std::move(importons.second)), radius, c.patches, nullptr, run);
    const ImportanceGuide caustic(PhotonMap(std::move(importons.first)), radius, c.patches, nullptr, run);
    const LightGuides user_paths(c.scene, c.user_paths);
    std::atomic<bool> found = false;
    parallel_blocks(extent.light_paths, kPathsOfBlock, run, [&](std::int64_t i) {
        if (found) return;
        Rng rng(seed, StreamPurpose::emission, static_cast<std::uint64_t>(i));
        VisiblePower sink{global, caustic, c.storage()};
        trace_light_path(c.scene, {&user_paths, nullptr}, depth, rng, sink);
        if (sink.found) found = true;
    });
    return found;
}

bool stage_one_finds_light(const SamplerContext& c, const Extent& extent, const RunContext& run) {
    const auto depth = static_cast<int>(c.settings.max_depth);
    const PathSet set{.coverage = c.coverage, .weight = c.weight};
    const GuidedPaths guides(c.scene, c.user_paths, set, depth);
    const StageOneSettings first{.set = set,
                                 .max_scatterings = depth,
                                 .samples = extent.brightness_samples,
                                 .seed = seed_of_trial(c.settings),
                                 .guides = c.user_paths.empty() ? nullptr : &guides};
    return run_stage_one(c.scene, first, run).brightness.mean() > 0;
}

/// Whether light paths come near anything that eye paths come near, walls between them or not, for light may pass
/// through a gap that no trial found; or whether any way of stage one joins the two. @throws Interrupted
bool may_be_lit(const SamplerContext& context, const RunContext& run) {
    const Extent extent(context.settings);
    return light_comes_near(context, extent, run) || stage_one_finds_light(context, extent, run);
}

constexpr std::int64_t kBlocks = 64;

/// Adds up one path after the other.
struct SurveySink {
    SceneSurvey survey;
    using LooksThroughGlass = std::true_type;
    std::array<double, 5> path{};
    bool saw_surface = false;

    bool arrival(const EyeWalk& walk, const Rgb& /*throughput*/, int /*finite*/) {
        if (walk.size() > 2) return true;
        const Vertex& seen = walk.back();
        const BsdfTraits traits = seen.bsdf.traits();
        const Vec3 back = direction(seen.point, walk[0].point);
        saw_surface = true;
        survey.specular += traits.delta ? 1 : 0;
        survey.glossy += traits.glossy ? seen.bsdf.glossy_probability(back) : 0;
        survey.diffuse += traits.diffuse ? 1 : 0;
        return true;
    }
    void contribution(const EyeWalk& /*walk*/, const Vertex& x0, const Rgb& value, LightClass light) {
        const double y = luminance(value);
        path[static_cast<std::size_t>(light)] += y;
        survey.by_emitter[x0.point.emitter] += y;
    }
    void end() {
        for (std::size_t k = 0; k < path.size(); ++k) survey.light[k].add(path[k]);
        survey.nothing += saw_surface ? 0 : 1;
        ++survey.samples;
        path = {};
        saw_surface = false;
    }
};

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
    return {name, found.coverage.has_value(),
            percent(found.beyond) + " of all light arrives where few gather rays do" +
                (found.coverage ? ": what is seen of it is stored" : ", but of what is seen gather rays find enough")};
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

double SceneSurvey::total() const {
    double sum = 0;
    for (const RunningStats& l : light) sum += l.mean();
    return sum;
}

SceneSurvey survey_scene(const Scene& scene, std::int64_t samples, int max_scatterings, std::uint64_t seed,
                         const RunContext& context) {
    std::vector<SurveySink> sinks(kBlocks);
    parallel_for(kBlocks, context, [&](std::int64_t b) {
        SurveySink& sink = sinks[static_cast<std::size_t>(b)];
        sink.survey.by_emitter.assign(scene.emitters().size(), 0.0);
        const Range range = split(samples, kBlocks, b);
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            Rng rng(seed, StreamPurpose::survey, static_cast<std::uint64_t>(i));
            trace_path(scene, lattice_image_point(seed, StreamPurpose::survey, i), max_scatterings, rng, sink);
            sink.end();
        }
    });
    SceneSurvey all;
    all.by_emitter.assign(scene.emitters().size(), 0.0);
    for (const SurveySink& sink : sinks) {
        const SceneSurvey& s = sink.survey;
        all.samples += s.samples;
        for (std::size_t k = 0; k < all.light.size(); ++k) all.light[k].merge(s.light[k]);
        for (std::size_t k = 0; k < all.by_emitter.size(); ++k) all.by_emitter[k] += s.by_emitter[k];
        all.specular += s.specular;
        all.glossy += s.glossy;
        all.diffuse += s.diffuse;
        all.nothing += s.nothing;
    }
    const double share = 1 / static_cast<double>(samples);
    for (double& e : all.by_emitter) e *= share;
    for (double* part : {&all.specular, &all.glossy, &all.diffuse, &all.nothing}) *part *= share;
    return all;
}

RenderPlan plan_render(const SamplerContext& c, const RunContext& run, std::int64_t survey_samples) {
    const Settings& s = c.settings;
    RenderPlan plan;
    plan.survey = survey_scene(c.scene, survey_samples, static_cast<int>(s.max_depth), s.seed, run);
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
