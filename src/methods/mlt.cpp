// --method mlt: Metropolis light transport (Veach and Guibas 1997) with the chains of Metropolis photon sampling.
//
// Chains draw what the photon maps would hold, indirect light and caustics. Emission, direct light and direct light at
// the second surface seen are path-traced, as stage three of mps has them: independent samples with next-event
// estimation find them at once, and chains would spend most of their steps there. Where few paths from the eye come,
// direct light at the second surface is left to the chains as well.
#include "film/splats.h"
#include "methods/chain_report.h"
#include "methods/method.h"
#include "methods/photons/find_coverage.h"
#include "methods/pixel_sink.h"
#include "methods/sample_report.h"
#include "sampling/markov/chain_rounds.h"
#include "sampling/proposals/registry.h"
#include "session/passes.h"
#include "session/pixel_sampling.h"
#include "session/stage_clock.h"
#include "session/work.h"

#include <span>

namespace keyhole {
namespace {

/// What the units of a pass have in common.
struct PassStart {
    std::int64_t pass = -1;
    StageOneSettings settings{};
    StageOne one;
    std::vector<Path> seeds;
    bool whole = false; ///< not cut short by a stop

    bool is_dark() const { return !(one.brightness.mean() > 0); }
};

PassStart start_pass(const Scene& scene, const Settings& settings, const StageOneSettings& first, std::int64_t pass,
                     ChainReports& reports, RenderStats& stats, const RunContext& context) {
    PassStart start{.pass = pass, .settings = first, .one = {}, .seeds = {}};
    start.one = reports.measure_brightness(scene, first, stats, context);
    start.whole = start.one.is_whole();
    if (start.is_dark()) return start;
    const StageClock clock(stats, stages::seeds);
    start.seeds = choose_seeds(scene, first, start.one, start.one.all_groups(), settings.chains);
    return start;
}

/// Takes some rounds of samples of everything that the chains leave out. Returns whether it got through them.
bool sample_direct(const Scene& scene, const Settings& settings, const PathSet& chains, Range rounds, Film& film,
                   PixelSampling& pixels, RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, stages::direct_light);
    const auto depth = static_cast<int>(settings.max_depth);
    const SamplingStage stage(scene, rounds.size(), "direct light", context);
    for (std::int64_t round = rounds.begin; round < rounds.end; ++round)
        if (!pixels.take_round(film, round, context, [&](const Vec2& image, SampleSource& source) {
                PixelSink sink{&chains};
                trace_path(scene, image, depth, source, sink);
                return sink.pixel;
            }))
            return false;
    return true;
}

void splat(SplatFilm& splats, const ImageWindow& window, const Path& path, double weight) {
    splats.add(window.to_pixel(path.image), SplatFilm::layer_of(light_class(path)),
               path.contribution * (weight / path.target));
}

/// Runs a group of the chains of a pass and adds what they draw. Returns whether they got to their end.
bool draw_chains(const Scene& scene, const Settings& settings, const UserPaths& paths, const PassStart& start,
                 Range group, Work& work, ChainReports& reports, RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, stages::chains);
    const ChainMixtures mixtures({&scene, start.settings.set, static_cast<int>(settings.max_depth), &paths}, settings);
    const auto seeds =
        std::span(start.seeds).subspan(static_cast<std::size_t>(group.begin), static_cast<std::size_t>(group.size()));
    ChainSet chains(seeds, mixtures.mixture, start.settings.seed, mixtures.control_or_null(), group.begin);
    const ImageWindow& window = scene.camera().window();
    SplatFilm splats(window.width, window.height, PixelFilter(settings));

    constexpr std::int64_t kRound = 64;
    const std::int64_t per_chain =
        std::max<std::int64_t>(1, settings.mutations / static_cast<std::int64_t>(start.seeds.size()));
    const ProgressStage progress(context, "chains", per_chain * chains.size(), "mutations");
    const auto draw = [&](std::int64_t, const Path& path, double weight) { splat(splats, window, path, weight); };
    ChainRounds::of_length(per_chain, std::clamp<std::int64_t>(per_chain / 32, 1, kRound))
        .run(context, [&](std::int64_t n) { chains.advance(n, context, draw); });

    const bool whole = chains.steps() == per_chain;
    const ChainSummary summary = chains.summary();
    if (!whole && !work.is_first()) return false;
    reports.add(mixtures.mixture, summary, stats);
    work.unit().drawn->add(splats, start.one.brightness.mean() * window.pixels() / static_cast<double>(summary.steps),
                           work.half());
    return whole;
}

RenderResult render_mlt(const RenderTask& task) {
    const auto& [scene, settings, paths, context, share, findings, observer] = task;
    RenderResult result;
    RenderStats& stats = result.stats;
    const std::int64_t groups = chain_groups(settings);
    Work work(settings, scene.camera().window(), AccumulationBuffer::Parts::both, share, groups,
              Work::PassStart::costly);
    ChainReports reports;
    PixelSampling pixels(scene, settings, share, StreamPurpose::path_tracing); // direct light
    if (!findings.plan && !findings.coverage) findings.coverage = find_coverage(scene, settings, context);
    const std::optional<GatherCoverage>& coverage =
        findings.plan ? findings.plan->coverage : findings.coverage->coverage;
    const PathSet set{.coverage = coverage ? &*coverage : nullptr};
    const GuidedPaths guides(scene, paths, set, static_cast<int>(settings.max_depth));
    PassStart start;
    while (const auto unit = work.take(context)) {
        const std::int64_t pass = work.pass_of(*unit), group = *unit % groups;
        const Range of_pass = rounds_of_group(settings.spp, groups, group);
        const Range rounds{pass * settings.spp + of_pass.begin, pass * settings.spp + of_pass.end};
        bool whole = sample_direct(scene, settings, set, rounds, *work.unit().film, pixels, stats, context);
        if (!whole && !work.is_first()) break;
        if (start.pass != pass) {
            const StageOneSettings first{.set = set,
                                         .max_scatterings = static_cast<int>(settings.max_depth),
                                         .samples = settings.brightness_samples,
                                         .error = settings.brightness_error,
                                         .seed = seed_of_pass(settings, pass),
                                         .guides = paths.empty() ? nullptr : &guides};
            start = start_pass(scene, settings, first, pass, reports, stats, context);
        }
        whole = whole && start.whole;
        if (!start.is_dark())
            whole = draw_chains(scene, settings, paths, start, chains_of_group(start.seeds.size(), groups, group), work,
                                reports, stats, context) &&
                    whole;
        else if (whole)
            work.unit().drawn->add(SplatFilm(scene.camera().window().width, scene.camera().window().height), 0,
                                   work.half());
        if (whole) work.end_unit(stats);
    }
    reports.finish(stats);
    pixels.report(stats);
    report_eye_samples(pixels.luminances(), scene, stats);
    report_lost_caustics(scene, stats, true);
    result.picture = work.finish(stats);
    return result;
}

} // namespace

constinit const Method methods::mlt{.name = "mlt",
                                    .help = "Metropolis light transport: the chains of mps, drawn directly",
                                    .follows_user_paths = true,
                                    .asks_for_direct_light = true,
                                    .trial = {.share = 0.09, .doubt = 1.5, .needless_below = 0.05},
                                    .render = render_mlt};

} // namespace keyhole
