// --method mlt: Metropolis light transport (Veach and Guibas 1997) with the chains of Metropolis photon sampling.
//
// Chains draw what the photon maps would hold, indirect light and caustics. Emission, direct light and direct light at
// the second surface seen are path-traced, as stage three of mps has them: independent samples with next-event
// estimation find them at once, and chains would spend most of their steps there.
#include "film/splats.h"
#include "render/chain_report.h"
#include "render/methods.h"
#include "render/pixel_sink.h"
#include "render/pixels.h"
#include "render/stage_clock.h"
#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

/// Samples everything that the chains leave out.
Picture sample_direct(const Scene& scene, const Settings& settings, RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, "direct light");
    Film film(scene.camera().window().width, scene.camera().window().height, PixelFilter(settings));
    const auto depth = static_cast<int>(settings.max_depth);
    const auto rounds =
        sample_pixels(scene, film, settings.spp, static_cast<std::uint64_t>(settings.seed), StreamPurpose::path_tracing,
                      "direct light", context, [&](const Vec2& image, SampleSource& source) {
                          PixelSink sink{PixelSink::Elsewhere::stored};
                          trace_path(scene, image, depth, source, sink);
                          return sink.pixel;
                      });
    stats.complete = rounds == settings.spp;
    film.report(stats);
    return film.to_picture();
}

void splat(SplatFilm& splats, const ImageWindow& window, const Path& path, double weight) {
    const auto layer =
        storage_point(path).kind == PhotonKind::caustic ? SplatFilm::Layer::caustic : SplatFilm::Layer::indirect;
    splats.add(window.to_pixel(path.image), layer, path.contribution * (weight / path.target));
}

/// Runs the chains and adds what they draw to `picture`.
void draw_chains(const Scene& scene, const Settings& settings, const UserPaths& paths, const StageOneSettings& first,
                 const StageOne& one, Picture& picture, RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, "chains");
    const ChainMixtures mixtures({&scene, PathSet::stored, static_cast<int>(settings.max_depth)}, settings, paths);
    ChainSet chains(choose_seeds(scene, first, one, one.all_groups(), settings.chains), mixtures.mixture, first.seed,
                    mixtures.control_or_null());
    const ImageWindow& window = scene.camera().window();
    SplatFilm splats(picture.width, picture.height, PixelFilter(settings));

    // In rounds, so that a stop finds all chains equally long.
    constexpr std::int64_t kRound = 64;
    const std::int64_t per_chain = std::max<std::int64_t>(1, settings.mutations / chains.size());
    context.begin("chains", static_cast<std::uint64_t>(per_chain * chains.size()), "mutations");
    while (chains.steps() < per_chain && !(context.stopped() && chains.steps() > 0))
        chains.advance(std::min(std::clamp<std::int64_t>(per_chain / 32, 1, kRound), per_chain - chains.steps()),
                       context,
                       [&](std::int64_t, const Path& path, double weight) { splat(splats, window, path, weight); });
    context.end();

    const ChainSummary summary = chains.summary();
    report_chains(stats, mixtures.mixture, summary);
    stats.complete = stats.complete && chains.steps() == per_chain;
    splats.add_to(picture, one.brightness.mean() * window.pixels() / static_cast<double>(summary.steps));
}

} // namespace

RenderResult render_mlt(const Scene& scene, const Settings& settings, const UserPaths& paths,
                        const RunContext& context) {
    RenderResult result;
    const StageOneSettings first{.max_scatterings = static_cast<int>(settings.max_depth),
                                 .samples = settings.brightness_samples,
                                 .seed = static_cast<std::uint64_t>(settings.seed)};
    result.picture = sample_direct(scene, settings, result.stats, context);
    const StageOne one = measure_brightness(scene, first, result.stats, context);
    warn_of_brightness(result.stats, one.samples < first.samples);
    if (one.brightness.mean() > 0)
        draw_chains(scene, settings, paths, first, one, result.picture, result.stats, context);
    return result;
}

} // namespace keyhole
