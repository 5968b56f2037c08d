#include "methods/photons/pass_gather.h"

#include "core/statistics.h"
#include "gather/fill_cache.h"
#include "gather/gather_effort.h"
#include "methods/photons/memory_plan.h"
#include "methods/photons/photon_report.h"
#include "session/stage_clock.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace keyhole {
namespace {

/// Share of the time for stage three that the samples of pixels get at least.
constexpr double kForSamples = 0.25;
/// Rays that records get in the end over those they have first, at most.
constexpr double kMostMoreRays = 16;
/// Gather rays of a sample at least and at most, if their number is to be found, and with how few it is asked for.
/// Bright reflections that a ray finds in thousands of samples are not among those that this is told by.
constexpr double kLeastGatherRays = 3, kFewestGatherRays = 1, kMostGatherRays = 8, kUsualGatherRays = 4;
/// Pixels of the picture for one that this is found by, and the least number of those.
constexpr int kPixelsForOne = 16, kLeastPixels = 32;
/// What a sample of a pixel costs besides gather rays, in these: by time 0.5 to 4.
constexpr double kCostBesides = 1;
/// Roughness that a lobe has at least where one of kUsualRays rays of a record ends.
constexpr double kLeastAlpha = 0.1, kUsualRays = 300;

const PilotedMap* null_if_empty(const PilotedMap& map) { return map.main_photons().photons().empty() ? nullptr : &map; }

/// Roughness that lobes have at least where gather rays end. One of roughness alpha reflects a lamp with a radiance
/// that goes as alpha^-2 into a solid angle that goes as alpha^2, so N rays have a variance that goes as alpha^-2 / N,
/// and the square of the bias grows as alpha^4: both are least together where alpha goes as N^(-1/6).
double least_alpha(const Settings& settings, const Radii& radii) {
    const auto rays = static_cast<double>(std::max<std::int64_t>(1, settings.cache_rays));
    return std::min(1.0, kLeastAlpha * std::pow(rays / kUsualRays, -1 / 6.0) * radii.shrink);
}

LookupOptions lookups(const Settings& settings, const Radii& radii) {
    return {.nearest = static_cast<int>(settings.nearest),
            .max_radius = radii.global,
            .caustic_radius = radii.caustic,
            .shrink = radii.shrink,
            .least_alpha = least_alpha(settings, radii)};
}

} // namespace

PassGather::PassGather(const SamplerContext& c, const RenderPlan& plan, std::int64_t pass, std::uint64_t seed,
                       Photons photons, RenderStats& stats, const RunContext& context)
    : window_(c.scene.camera().window()), seed_(seed), coverage_(c.coverage), global_(std::move(photons.global)),
      caustic_(std::move(photons.caustic)) {
    const Settings& s = c.settings;
    const Radii radii(c.scene, pass);
    if (plan.photons) {
        const StageClock clock(stats, stages::irradiance);
        estimate_irradiance(c, radii, seed, stats, context);
        outlying_ = OutlyingPhotons(caustic_, static_cast<int>(s.nearest), radii.caustic, radii.shrink, &c.patches);
        caustic_surroundings_.emplace(caustic_, c.patches, static_cast<int>(s.nearest), radii.caustic, radii.shrink);
        stats.photon_bytes = std::max<std::uint64_t>(
            stats.photon_bytes, global_.bytes() + caustic_.bytes() + caustic_surroundings_->bytes() +
                                    (irradiance_ ? irradiance_->bytes() + direct_irradiance_->bytes() : 0));
    }
    const StageClock clock(stats, stages::cache);
    GatherMaps maps{.global = null_if_empty(global_),
                    .irradiance = irradiance_ ? &*irradiance_ : nullptr,
                    .direct = direct_irradiance_ ? &*direct_irradiance_ : nullptr,
                    .caustic = null_if_empty(caustic_),
                    .caustic_surroundings = caustic_surroundings_ ? &*caustic_surroundings_ : nullptr,
                    .outlying = &outlying_,
                    .patches = &c.patches,
                    .coverage = c.coverage};
    const auto rays = [&] { return GatherRays(c.scene, maps, lookups(s, radii), static_cast<int>(s.max_depth)); };
    // A ray that is traced on ends where no gather ray of a visible point may come.
    if (irradiance_ && photons.everywhere && c.coverage == nullptr && c.scene.traits().glossy)
        maps.lobes = &lobes_.emplace(rays(), seed, context);
    rays_.emplace(rays());
    GatherSamples samples{.light = static_cast<int>(s.light_samples),
                          .rays = plan.gather ? s.gather_rays.value.value_or(0) : kFewestGatherRays};
    const auto find_rays = [&](const IrradianceCache* cache) {
        if (!(samples.rays > 0))
            samples.rays = context.stopped() ? kUsualGatherRays : gather_rays_that_pay(cache, samples);
    };
    if (plan.cache) {
        CacheOptions options = cache_options(s, static_cast<double>(radii.shrink), seed);
        options.rays_for_pixel = context.rays_for_pixel;
        RaysOfRecords decide;
        if (context.by_time && context.communicator == nullptr)
            decide = [&](const PlacedRecords& placed) {
                find_rays(&placed.cache);
                return rays_worth_their_time(placed, samples, context);
            };
        spots_ = find_hot_spots(*rays_, options, context);
        if (spots_.size() > 0) maps.spots = &spots_, rays_.emplace(rays());
        cache_ = fill_cache(*rays_, spots_, options, c.with_reserve(context, kForSamples), decide);
    }
    find_rays(cache());
    gather_.emplace(*rays_, cache(), &spots_, samples);
}

void PassGather::estimate_irradiance(const SamplerContext& c, const Radii& radii, std::uint64_t seed,
                                     RenderStats& stats, const RunContext& context) {
    const Settings& s = c.settings;
    // An estimate made beforehand is asked from a little way off. Once regions get as small as that, each is made where
    // it is asked.
    const float photons_in_region = static_cast<float>(s.nearest) * radii.shrink * radii.shrink;
    if (!(photons_in_region > 2.0f * kPilotEvery)) return;
    irradiance_.emplace(global_.pilots(), global_.main_photons(),
                        IrradianceOptions{.k = static_cast<int>(s.nearest),
                                          .max_radius = radii.global,
                                          .shrink = radii.shrink,
                                          .patches = &c.patches,
                                          .coverage = c.coverage,
                                          .by_length = c.scene.traits().delta && length_matters(s),
                                          .grid_bytes = memory_for_lookups(s, global_.size() + caustic_.size(),
                                                                           global_.pilots().photons().size()),
                                          .scene = &c.scene},
                        context);
    report_lookups(*irradiance_, photons_in_region, stats);
    // Of paths by a visible point and one place.
    const int faces = std::clamp(static_cast<int>(s.max_depth) - 2, 0, kMostFaces);
    direct_irradiance_.emplace(c.scene, irradiance_->places(), faces, seed, context);
}

double PassGather::gather_rays_that_pay(const IrradianceCache* cache, GatherSamples samples) const {
    if (cache != nullptr && !rays_->scene().traits().glossy) return kUsualGatherRays; // where it has no record
    const auto effort = [&](double rays) {
        samples.rays = rays;
        // Of a trial, whose window is small, no more than pays there.
        const int pixels = std::clamp(static_cast<int>(window_.size()) / kPixelsForOne, kLeastPixels, kPixelsForNoise);
        const auto noise = noise_of(FinalGather(*rays_, cache, &spots_, samples), window_, seed_, pixels);
        return noise ? GatherEffort{rays, noise->samples, kCostBesides + noise->rays} : GatherEffort{rays, 0, 1};
    };
    const GatherEffort few = effort(kFewestGatherRays);
    return std::max(kLeastGatherRays, best_gather_rays(few, effort(kMostGatherRays)));
}

/// The squared error of the picture is C / R + A / S with R rays of records and S samples of pixels, which share the
/// time as c R + s S. It is least where the derivatives by time are the same for both.
int PassGather::rays_worth_their_time(const PlacedRecords& placed, const GatherSamples& samples,
                                      const RunContext& context) const {
    const FinalGather gather(*rays_, &placed.cache, &spots_, samples);
    const double start = context.stop->seconds_left();
    const auto noise = noise_of(gather, window_, seed_);
    const double left = context.stop->seconds_left();
    if (!noise || !(noise->records > 0) || !(placed.seconds > 0) || !(start > left)) return placed.rays;
    const double of_ray = placed.seconds / placed.rays;
    const double of_sample = (start - left) / (kPixelsForNoise * kSamplesInPixel) * window_.size();
    const double share = best_share_of_time(noise->records * placed.rays * of_ray, noise->samples * of_sample);
    const double rays = share * (left + placed.seconds) / of_ray;
    return static_cast<int>(std::clamp(rays, static_cast<double>(placed.rays), kMostMoreRays * placed.rays));
}

void PassGather::report(RenderStats& stats, bool check_for_false_spots) const {
    if (cache_) report_cache(*cache_, gather_->starving(), stats);
    if (check_for_false_spots && !caustic_.main_photons().photons().empty()) report_false_spots(*gather_, seed_, stats);
    stats.photon_quality.noise = noise_of(*gather_, window_, seed_);
}

} // namespace keyhole
