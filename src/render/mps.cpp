// --method mps: the three stages of Metropolis photon sampling (Fan, Chenney, Lai 2005).
#include "gather/final_gather.h"
#include "photonmap/photon_sampling.h"
#include "render/chain_report.h"
#include "render/methods.h"
#include "render/pixels.h"
#include "render/stage_clock.h"
#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

/// Radii of lookups follow the size of the scene; they bound how far light can leak, and matter only where photons are
/// so few that the nearest ones lie farther away.
struct Radii {
    float importance, global, caustic;
    explicit Radii(const Scene& scene) {
        const float size = (scene.upper() - scene.lower()).length();
        importance = 0.1f * size;
        global = 0.02f * size;
        caustic = 0.02f * size;
    }
};

ImportanceMap make_importance_map(std::vector<Importon>& importons, std::int64_t samples,
                                  const ImportanceOptions& options) {
    std::vector<Photon> compact;
    compact.reserve(importons.size());
    for (const Importon& i : importons)
        compact.emplace_back(i.position, i.ng, i.to_eye, i.weight / static_cast<double>(samples));
    std::vector<Importon>().swap(importons);
    return {std::move(compact), options};
}

/// Each photon weighs the same where it is asked, so the maps share the ceiling as they share the light. Either keeps
/// a little where stage one may have missed its paths.
std::size_t caustic_share(const StageOne& one, const Scene& scene, std::int64_t photons) {
    if (!scene.traits().delta) return 0;
    const double share = one.caustic.mean() / one.brightness.mean();
    return static_cast<std::size_t>(std::clamp(share, 0.02, 0.98) * static_cast<double>(photons));
}

/// Stage two: chains from the seeds of stage one, photons with the power that the importance map gives them.
SampledPhotons run_stage_two(const Scene& scene, const Settings& settings, const StageOneSettings& first,
                             const UserPaths& paths, const StageOne& one, const SurfacePatches& patches,
                             RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, "photons");
    const Radii radii(scene);
    const std::vector<Path> seeds = choose_seeds(scene, first, one, settings.chains);
    const ImportanceOptions options{.k = 50, .max_radius = radii.importance, .patches = &patches};
    Importance importance = trace_importance(scene, first.max_scatterings, settings.importons, first.seed, context);
    const ImportanceMap at_d1 = make_importance_map(importance.first, importance.samples, options);
    const ImportanceMap at_d2 = make_importance_map(importance.second, importance.samples, options);
    stats.importons = at_d1.map().photons().size() + at_d2.map().photons().size();
    stats.importon_bytes = at_d1.bytes() + at_d2.bytes();

    const ProposalContext proposals{&scene, PathSet::stored, static_cast<int>(settings.max_depth)};
    const ChainMixtures mixtures(proposals, settings, paths);
    const std::size_t caustic = caustic_share(one, scene, settings.photons);
    const PhotonSamplingOptions sampling{.mutations = settings.mutations,
                                         .global_photons = static_cast<std::size_t>(settings.photons) - caustic,
                                         .caustic_photons = caustic,
                                         .brightness = one.brightness.mean(),
                                         .seed = static_cast<std::uint64_t>(settings.seed),
                                         .control = mixtures.control_or_null()};
    SampledPhotons photons = sample_photons(seeds, mixtures.mixture, {&at_d2, &at_d1}, sampling, context);
    report_chains(stats, mixtures.mixture, photons.chains);
    stats.photons_global = photons.global.size();
    stats.photons_caustic = photons.caustic.size();
    stats.values["share of power without importance"] = photons.lost_share;
    return photons;
}

} // namespace

RenderResult render_mps(const Scene& scene, const Settings& settings, const UserPaths& paths,
                        const RunContext& context) {
    RenderResult result;
    RenderStats& stats = result.stats;
    const SurfacePatches patches(scene.shapes());
    const Radii radii(scene);

    const StageOneSettings first{.max_scatterings = static_cast<int>(settings.max_depth),
                                 .samples = settings.brightness_samples,
                                 .seed = static_cast<std::uint64_t>(settings.seed)};
    const StageOne one = measure_brightness(scene, first, stats, context);

    SampledPhotons photons;
    if (one.brightness.mean() > 0) photons = run_stage_two(scene, settings, first, paths, one, patches, stats, context);

    Film film(scene.camera().window().width, scene.camera().window().height, PixelFilter(settings));
    {
        const StageClock clock(stats, "gather");
        const PhotonMap global(std::move(photons.global)), caustic(std::move(photons.caustic));
        const IrradianceOptions irradiance_options{
            .k = static_cast<int>(settings.nearest), .max_radius = radii.global, .patches = &patches};
        const IrradianceMap irradiance(global, irradiance_options, context);
        stats.photon_bytes = global.bytes() + caustic.bytes() + irradiance.bytes();
        stats.values["photons per lookup"] = irradiance.mean_photons();
        const GatherMaps maps{.global = global.photons().empty() ? nullptr : &global,
                              .irradiance = &irradiance,
                              .caustic = caustic.photons().empty() ? nullptr : &caustic,
                              .patches = &patches};
        const GatherOptions gathering{.rays = static_cast<int>(settings.gather_rays),
                                      .nearest = static_cast<int>(settings.nearest),
                                      .max_radius = radii.global,
                                      .caustic_radius = radii.caustic,
                                      .max_scatterings = static_cast<int>(settings.max_depth)};
        const FinalGather gather(scene, maps, gathering);
        const auto rounds = sample_pixels(
            scene, film, settings.spp, static_cast<std::uint64_t>(settings.seed), StreamPurpose::gather, "gather",
            context, [&](const Vec2& image, SampleSource& source) { return gather.sample(image, source); });
        stats.complete = rounds == settings.spp;
    }
    film.report(stats);
    result.picture = film.to_picture();
    return result;
}

} // namespace keyhole
