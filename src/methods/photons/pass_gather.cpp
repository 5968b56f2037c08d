#include "methods/photons/pass_gather.h"

#include "gather/fill_cache.h"
#include "methods/photons/photon_report.h"
#include "methods/photons/radii.h"

#include <algorithm>
#include <utility>

namespace keyhole {
namespace {

/// Share of the time for stage three that the samples of pixels get at least.
constexpr double kForSamples = 0.25;

const PilotedMap* null_if_empty(const PilotedMap& map) { return map.main_photons().photons().empty() ? nullptr : &map; }

LookupOptions lookups(const Settings& settings, const Radii& radii) {
    return {.nearest = static_cast<int>(settings.nearest),
            .max_radius = radii.global,
            .caustic_radius = radii.caustic,
            .shrink = radii.shrink};
}

} // namespace

PassGather::PassGather(const SamplerContext& c, const RenderPlan& plan, std::int64_t pass, std::uint64_t seed,
                       Photons photons, RenderStats& stats, const RunContext& context)
    : window_(c.scene.camera().window()), seed_(seed), global_(std::move(photons.global)), caustic_(std::move(photons.caustic)) {
    const Settings& s = c.settings;
    const Radii radii(c.scene, pass);
    // An estimate made beforehand is asked from a little way off. Once regions get as small as that, each is made where
    // it is asked.
    const float photons_in_region = static_cast<float>(s.nearest) * radii.shrink * radii.shrink;
    if (plan.photons && photons_in_region > 2.0f * kPilotEvery) {
        irradiance_.emplace(global_.pilots(), global_.main_photons(),
                            IrradianceOptions{.k = static_cast<int>(s.nearest),
                                              .max_radius = radii.global,
                                              .shrink = radii.shrink,
                                              .patches = &c.patches,
                                              .coverage = c.coverage,
                                              .scene = &c.scene},
                            context);
        report_lookups(*irradiance_, photons_in_region, stats);
        direct_irradiance_.emplace(c.scene, irradiance_->places(), DirectIrradianceOptions{.seed = seed}, context);
    }
    if (plan.photons)
        stats.photon_bytes = std::max<std::uint64_t>(
            stats.photon_bytes, global_.bytes() + caustic_.bytes() +
                                    (irradiance_ ? irradiance_->bytes() + direct_irradiance_->bytes() : 0));
    rays_.emplace(c.scene,
                  GatherMaps{.global = null_if_empty(global_),
                             .irradiance = irradiance_ ? &*irradiance_ : nullptr,
                             .direct = direct_irradiance_ ? &*direct_irradiance_ : nullptr,
                             .caustic = null_if_empty(caustic_),
                             .patches = &c.patches,
                             .coverage = c.coverage},
                  lookups(s, radii), static_cast<int>(s.max_depth));
    if (plan.cache)
        cache_ = fill_cache(*rays_, cache_options(s, static_cast<double>(radii.shrink), seed),
                            context.with_reserve(kForSamples));
    gather_.emplace(*rays_, cache_ ? &*cache_ : nullptr,
                    GatherSamples{.light = static_cast<int>(s.light_samples),
                                  .rays = plan.gather ? static_cast<int>(s.gather_rays) : 1});
}

void PassGather::report(RenderStats& stats) const {
    if (cache_) report_cache(*cache_, gather_->starving(), stats);
    if (!caustic_.main_photons().photons().empty()) report_false_spots(*gather_, seed_, stats);
    report_noise(*gather_, window_, seed_, stats);
}

} // namespace keyhole
