// The methods that render from photon maps: pass by pass a sampler, the maps, the gather.
#include "gather/fill_cache.h"
#include "gather/final_gather.h"
#include "render/methods.h"
#include "render/pass_seed.h"
#include "render/photon_file.h"
#include "render/photon_report.h"
#include "render/photon_sampler.h"
#include "render/pixels.h"
#include "render/plan.h"
#include "render/radii.h"
#include "render/sample_report.h"
#include "render/sampler_trial.h"
#include "render/stage_clock.h"
#include "render/work.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

/// What `auto` stands for in this scene; says so.
std::string choose_method(const SamplerContext& c, RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, "trial of samplers");
    const SamplerTrial trial = try_samplers(c, context);
    std::string method(trial.best());
    const double better = std::min(trial.emission, trial.metropolis);
    stats.remarks.push_back(
        std::isfinite(better)
            ? fmt::format("method {} chosen: for the same error ipm would need {:.2g} times the work, mps {:.2g} times",
                          method, trial.emission / better, trial.metropolis / better)
            : "method ipm chosen: no light that photon maps would hold was found in a trial");
    return method;
}

/// Where no light is that photon maps would hold.
class NoPhotons final : public PhotonSampler {
  public:
    Photons sample(std::uint64_t /*seed*/, RenderStats& /*stats*/, const RunContext& /*context*/) override {
        return {};
    }
};

RenderPlan make_plan(const SamplerContext& c, RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, "plan");
    RenderPlan plan = plan_render(c, context);
    if (!plan.photons) stats.remarks.push_back("stopped before the photons: " + plan.items.front().why);
    return plan;
}

std::unique_ptr<PhotonSampler> make_sampler(const SamplerContext& c, const RenderPlan& plan, RenderStats& stats,
                                            const RunContext& context) {
    if (!c.settings.load_map.empty()) return make_file_sampler(c);
    if (!plan.photons) return std::make_unique<NoPhotons>();
    const std::string method = c.settings.method == "auto" ? choose_method(c, stats, context) : c.settings.method;
    stats.method = method;
    if (method == "mps") return make_metropolis_sampler(c);
    if (method == "pss") return make_light_chain_sampler(c);
    return make_emission_sampler(c, method == "ipm");
}

/// Share of the time for stage three that the samples of pixels get at least.
constexpr double kForSamples = 0.25;

/// Stage three: what the eye sees, from the photons of a pass. Returns whether it was completed.
bool gather_pass(const SamplerContext& c, const RenderPlan& plan, std::int64_t pass, std::uint64_t seed,
                 Photons photons, Film& film, RunningStats& luminance, RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, "gather");
    const Settings& s = c.settings;
    const Radii radii(c.scene, pass);
    stats.photons_global = photons.global.size();
    stats.photons_caustic = photons.caustic.size();
    report_power(photons, stats);
    const ScoutedMap global(std::move(photons.global)), caustic(std::move(photons.caustic));
    const IrradianceOptions estimates{.k = static_cast<int>(s.nearest),
                                      .max_radius = radii.global,
                                      .shrink = radii.shrink,
                                      .patches = &c.patches,
                                      .reach = c.reach,
                                      .scene = &c.scene};
    // An estimate made beforehand is asked from a little way off. Once regions get as small as that, each is made where
    // it is asked.
    std::optional<IrradianceMap> irradiance;
    if (plan.photons && static_cast<float>(s.nearest) * radii.shrink * radii.shrink > 2.0f * kScoutEvery)
        irradiance.emplace(global.scouts(), global.carriers(), estimates, context);
    if (irradiance) report_lookups(*irradiance, static_cast<double>(s.nearest) * radii.shrink * radii.shrink, stats);

    std::optional<Sites> sites;
    if (irradiance) {
        sites.emplace(c.scene, irradiance->places(), SiteOptions{.seed = seed}, context);
    }
    if (plan.photons)
        stats.photon_bytes =
            std::max<std::uint64_t>(stats.photon_bytes, global.bytes() + caustic.bytes() +
                                                            (irradiance ? irradiance->bytes() + sites->bytes() : 0));
    const GatherMaps maps{.global = global.carriers().photons().empty() ? nullptr : &global,
                          .irradiance = irradiance ? &*irradiance : nullptr,
                          .sites = sites ? &*sites : nullptr,
                          .caustic = caustic.carriers().photons().empty() ? nullptr : &caustic,
                          .patches = &c.patches,
                          .reach = c.reach};
    const LookupOptions lookups{.nearest = static_cast<int>(s.nearest),
                                .max_radius = radii.global,
                                .caustic_radius = radii.caustic,
                                .shrink = radii.shrink};
    const GatherRays rays(c.scene, maps, lookups, static_cast<int>(s.max_depth));
    std::optional<IrradianceCache> cache;
    if (plan.cache) cache = fill_cache(rays, cache_options(s, seed), context.with_reserve(kForSamples));
    if (cache) stats.values["cached irradiances"] = static_cast<double>(cache->size());
    const FinalGather gather(
        rays, cache ? &*cache : nullptr,
        {.light = static_cast<int>(s.light_samples), .rays = plan.gather ? static_cast<int>(s.gather_rays) : 1});
    const auto rounds = sample_pass(
        c.scene, film, {pass, s.spp, static_cast<std::uint64_t>(s.seed), StreamPurpose::gather, "gather"}, context,
        luminance, [&](const Vec2& image, SampleSource& source) { return gather.sample(image, source); });
    if (cache) report_starving(gather.starving(), stats);
    return rounds == s.spp;
}

} // namespace

RenderResult render_photons(const Scene& scene, const Settings& settings, const UserPaths& paths,
                            const RunContext& context, const Share& share) {
    RenderResult result;
    RenderStats& stats = result.stats;
    const SurfacePatches patches(scene.shapes());
    SamplerContext c{scene, settings, patches, paths};
    const RenderPlan plan = make_plan(c, stats, context);
    c.reach = plan.reach ? &*plan.reach : nullptr;
    c.caustics = plan.caustics || c.reach != nullptr;
    const auto sampler = make_sampler(c, plan, stats, context);
    Work work(settings, scene.camera().window(), Exposure::Parts::film, share);
    RunningStats luminance;
    while (const auto pass = work.take(context)) {
        const std::uint64_t seed = seed_of_pass(settings, *pass);
        Photons photons = sampler->sample(seed, stats, context);
        if (*pass == 0 && !settings.save_map.empty())
            save_photons(settings.save_map, photon_file_key(scene, settings, c.reach), photons);
        // The photons of a pass that was cut short are good for a first picture, not for one that is there.
        if (!work.is_first() && context.stopped()) break;
        if (gather_pass(c, plan, *pass, seed, std::move(photons), *work.unit().film, luminance, stats,
                        context.with_reserve(0)))
            work.end_unit(stats);
    }
    sampler->finish(stats);
    warn_of_photons(stats);
    report_eye_samples(luminance, scene, stats);
    result.picture = work.finish(stats);
    return result;
}

} // namespace keyhole
