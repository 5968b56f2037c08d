// --method bdpt: bidirectional path tracing (Veach 1997, chapter 10). Paths whose light sub-path is joined to the eye
// itself choose their pixel; all others belong to the pixel that the eye sub-path was traced for.
#include "film/splats.h"
#include "methods/method.h"
#include "methods/pixel_sink.h"
#include "methods/sample_report.h"
#include "sampling/paths/bidirectional_tracer.h"
#include "sampling/paths/image_lattice.h"
#include "session/pixel_sampling.h"
#include "session/stage_clock.h"
#include "session/work.h"

namespace keyhole {
namespace {

constexpr Stage kBidirectionalTracing{"bidirectional path tracing", &Settings::spp, 1};

/// Samples that tell about how bright a picture is.
constexpr int kPilot = 256;

struct BidirectionalSink {
    PixelSink& pixel;
    SplatFilm& splats;
    const ImageWindow& window;

    void contribution(const Connection& connection, const Rgb& value, LightClass light) {
        if (connection.t() > 1)
            pixel.add(value, light);
        else if (is_finite(value))
            splats.add(window.to_pixel(connection.image()), SplatFilm::layer_of(light), value);
    }
};

struct BrightnessSink {
    double sum = 0;
    void contribution(const Connection& /*connection*/, const Rgb& value, LightClass /*light*/) {
        if (is_finite(value)) sum += luminance(value);
    }
};

/// About that of the picture [W/(m^2 sr)]; 0 where few samples find nothing.
double pilot_brightness(const Scene& scene, const Settings& settings) {
    const auto depth = static_cast<int>(settings.max_depth);
    BrightnessSink sink;
    for (int i = 0; i < kPilot; ++i) {
        Rng rng(settings.seed, StreamPurpose::survey, static_cast<std::uint64_t>(i));
        const Vec2 image = lattice_image_point(settings.seed, StreamPurpose::survey, i);
        SubPathPair& pair = trace_both_subpaths(scene, image, depth, rng, rng);
        connect_subpaths(scene, pair, image, {depth, PathSet::all, settings.mis}, sink);
    }
    return sink.sum / kPilot;
}

bool has_light(const SplatFilm& splats) {
    for (std::size_t i = 0; i < splats.pixels(); ++i)
        for (const double sum : splats.sums(i))
            if (sum > 0) return true;
    return false;
}

PixelSample sample_pixel(const Scene& scene, const Vec2& image, int depth, MisHeuristic heuristic, SplatFilm& splats,
                         SampleSource& source) {
    SubPathPair& pair = trace_both_subpaths(scene, image, depth, source, source);
    const auto& eye = pair.eye;
    PixelSink pixel;
    for (std::size_t i = 1; i < eye.vertices.size() && !pixel.saw_surface; ++i)
        pixel.see(eye.vertices[i], eye.vertices[i - 1], eye.notes[i].throughput, i == 1);
    BidirectionalSink sink{pixel, splats, scene.camera().window()};
    connect_subpaths(scene, pair, image, {depth, PathSet::all, heuristic}, sink);
    return pixel.pixel;
}

RenderResult render_bdpt(const RenderTask& task) {
    const auto& [scene, settings, paths, context, share, findings, observer] = task;
    RenderResult result;
    const ImageWindow& window = scene.camera().window();
    Work work(settings, window, AccumulationBuffer::Parts::both, share, settings.spp, Work::PassStart::free);
    PixelSampling pixels(scene, settings, share, StreamPurpose::bidirectional);
    SplatFilm splats(window.width, window.height, PixelFilter(settings), pilot_brightness(scene, settings));
    // A light sub-path comes with each sample of a pixel, and is an estimate of the whole window.
    const double scale = window.pixels() / window.size();
    bool drew = false; // anything that only light sub-paths may have found, such as a sun through a pane
    {
        const StageClock clock(result.stats, kBidirectionalTracing);
        const SamplingStage stage(scene, work.left(), "bidirectional path tracing", context);
        const auto depth = static_cast<int>(settings.max_depth);
        while (const auto round = work.take(context)) {
            const bool whole =
                pixels.take_round(*work.unit().film, *round, context, [&](const Vec2& image, SampleSource& source) {
                    return sample_pixel(scene, image, depth, settings.mis, splats, source);
                });
            // Of later rounds that are cut short the eye's samples are enough.
            if ((whole || work.is_first()) && pixels.samples_per_pixel() > 0)
                work.unit().drawn->add(splats, scale / pixels.samples_per_pixel(), work.half());
            drew = drew || has_light(splats);
            splats.clear();
            if (whole) work.end_unit(result.stats);
        }
    }
    pixels.report(result.stats);
    report_samples(pixels.luminances(), scene, result.stats);
    if (!drew) report_black(pixels.luminances(), scene, result.stats);
    report_lost_caustics(scene, result.stats);
    report_sun_behind_glass(scene, result.stats);
    result.picture = work.finish(result.stats);
    return result;
}

} // namespace

constinit const Method methods::bdpt{.name = "bdpt",
                                     .help = "bidirectional path tracing",
                                     .samples_pixels = true,
                                     .scatters_in_media = true,
                                     .trial = {.share = 0.10, .by_work = true},
                                     .render = render_bdpt};

} // namespace keyhole
