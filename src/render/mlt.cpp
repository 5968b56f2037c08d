// --method mlt: Metropolis light transport (Veach and Guibas 1997) with the chains of Metropolis photon sampling.
//
// Chains draw what the photon maps would hold, indirect light and caustics. Emission, direct light and direct light at
// the second surface seen are path-traced, as stage three of mps has them: independent samples with next-event
// estimation find them at once, and chains would spend most of their steps there. Where few paths from the eye come,
// direct light at the second surface is left to the chains as well.
#include "film/splats.h"
#include "render/chain_report.h"
#include "render/find_reach.h"
#include "render/methods.h"
#include "render/pass_seed.h"
#include "render/pixel_sink.h"
#include "render/pixels.h"
#include "render/sample_report.h"
#include "render/stage_clock.h"
#include "render/work.h"
#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

/// Samples everything that the chains leave out. Returns whether it was completed.
bool sample_direct(const Scene& scene, const Settings& settings, const PathSet& chains, std::int64_t pass, Film& film,
                   RunningStats& luminance, RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, "direct light");
    const auto depth = static_cast<int>(settings.max_depth);
    const SamplePass rounds_of{pass, settings.spp, static_cast<std::uint64_t>(settings.seed),
                               StreamPurpose::path_tracing, "direct light"};
    const auto rounds =
        sample_pass(scene, film, rounds_of, context, luminance, [&](const Vec2& image, SampleSource& source) {
            PixelSink sink{&chains};
            trace_path(scene, image, depth, source, sink);
            return sink.pixel;
        });
    return rounds == settings.spp;
}

void splat(SplatFilm& splats, const ImageWindow& window, const Path& path, double weight) {
    const auto layer =
        light_class(path) == LightClass::caustic ? SplatFilm::Layer::caustic : SplatFilm::Layer::indirect;
    splats.add(window.to_pixel(path.image), layer, path.contribution * (weight / path.target));
}

/// Runs the chains of a pass and adds what they draw. Returns whether they got to their end.
bool draw_chains(const Scene& scene, const Settings& settings, const UserPaths& paths, const StageOneSettings& first,
                 const StageOne& one, Work& work, ChainReports& reports, RenderStats& stats,
                 const RunContext& context) {
    const StageClock clock(stats, "chains");
    const ChainMixtures mixtures({&scene, first.set, static_cast<int>(settings.max_depth)}, settings, paths);
    ChainSet chains(choose_seeds(scene, first, one, one.all_groups(), settings.chains), mixtures.mixture, first.seed,
                    mixtures.control_or_null());
    const ImageWindow& window = scene.camera().window();
    SplatFilm splats(window.width, window.height, PixelFilter(settings));

    // In rounds, so that a stop finds all chains equally long.
    constexpr std::int64_t kRound = 64;
    const std::int64_t per_chain = std::max<std::int64_t>(1, settings.mutations / chains.size());
    context.begin("chains", static_cast<std::uint64_t>(per_chain * chains.size()), "mutations");
    while (chains.steps() < per_chain && !(context.stopped() && chains.steps() > 0))
        chains.advance(std::min(std::clamp<std::int64_t>(per_chain / 32, 1, kRound), per_chain - chains.steps()),
                       context,
                       [&](std::int64_t, const Path& path, double weight) { splat(splats, window, path, weight); });
    context.end();

    const bool whole = chains.steps() == per_chain;
    const ChainSummary summary = chains.summary();
    if (!whole && !work.is_first()) return false;
    reports.add(mixtures.mixture, summary, stats);
    work.unit().drawn->add(splats, one.brightness.mean() * window.pixels() / static_cast<double>(summary.steps));
    return whole;
}

} // namespace

RenderResult render_mlt(const Scene& scene, const Settings& settings, const UserPaths& paths, const RunContext& context,
                        const Share& share) {
    RenderResult result;
    RenderStats& stats = result.stats;
    Work work(settings, scene.camera().window(), Exposure::Parts::both, share);
    ChainReports reports;
    RunningStats luminance; // of direct light
    const ReachFound found = find_reach(scene, settings);
    const PathSet set{.reach = found.reach ? &*found.reach : nullptr};
    const GuidedPaths guides(scene, paths, set, static_cast<int>(settings.max_depth));
    while (const auto pass = work.take(context)) {
        const StageOneSettings first{.set = set,
                                     .max_scatterings = static_cast<int>(settings.max_depth),
                                     .samples = settings.brightness_samples,
                                     .seed = seed_of_pass(settings, *pass),
                                     .guides = paths.empty() ? nullptr : &guides};
        bool whole = sample_direct(scene, settings, set, *pass, *work.unit().film, luminance, stats, context);
        if (!whole && !work.is_first()) break;
        const StageOne one = reports.measure_brightness(scene, first, stats, context);
        whole = whole && one.samples == first.samples;
        if (one.brightness.mean() > 0)
            whole = draw_chains(scene, settings, paths, first, one, work, reports, stats, context) && whole;
        else if (whole)
            work.unit().drawn->add(SplatFilm(scene.camera().window().width, scene.camera().window().height), 0);
        if (whole) work.end_unit(stats);
    }
    reports.finish(stats);
    report_eye_samples(luminance, scene, stats);
    result.picture = work.finish(stats);
    return result;
}

} // namespace keyhole
