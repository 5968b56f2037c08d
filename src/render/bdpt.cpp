// --method bdpt: bidirectional path tracing. Paths whose light sub-path is joined to the eye itself choose their pixel;
// all others belong to the pixel that the eye sub-path was traced for.
#include "film/splats.h"
#include "render/methods.h"
#include "render/mis_heuristic.h"
#include "render/pixel_sink.h"
#include "render/pixels.h"
#include "render/sample_report.h"
#include "render/stage_clock.h"
#include "render/work.h"
#include "sampling/bidirectional_tracer.h"

namespace keyhole {
namespace {

struct BidirectionalSink {
    PixelSink& pixel;
    SplatFilm& splats;
    const ImageWindow& window;

    void contribution(const Joint& joint, const Rgb& value, LightClass light) {
        if (joint.t() > 1)
            pixel.add(value, light);
        else if (is_finite(value))
            splats.add(window.to_pixel(joint.image()), SplatFilm::layer_of(light), value);
    }
};

PixelSample sample_pixel(const Scene& scene, const Vec2& image, int depth, MisHeuristic heuristic, SplatFilm& splats,
                         SampleSource& source) {
    auto& [eye, light] = SubPathPair::scratch();
    trace_eye_subpath(scene, image, most_eye_vertices(depth), source, &source, eye);
    trace_light_subpath(scene, most_light_vertices(depth), source, &source, light);
    PixelSink pixel;
    for (std::size_t i = 1; i < eye.vertices.size() && !pixel.saw_surface; ++i)
        pixel.see(eye.vertices[i], eye.vertices[i - 1], eye.notes[i].throughput, i == 1);
    BidirectionalSink sink{pixel, splats, scene.camera().window()};
    connect_subpaths(scene, light, eye, image, depth, PathSet::all, heuristic, sink);
    return pixel.pixel;
}

} // namespace

RenderResult render_bdpt(const Scene& scene, const Settings& settings, const RunContext& context, const Share& share) {
    RenderResult result;
    const ImageWindow& window = scene.camera().window();
    RunningStats luminance;
    Work work(settings, window, Exposure::Parts::both, share, settings.spp, Work::PassStart::free);
    SplatFilm splats(window.width, window.height, PixelFilter(settings));
    // One light sub-path for each pixel and round, each an estimate of the whole window.
    const double scale = window.pixels() / (static_cast<double>(window.width) * window.height);
    {
        const StageClock clock(result.stats, "bidirectional path tracing");
        const SamplingStage stage(scene, work.left(), "bidirectional path tracing", context);
        const auto depth = static_cast<int>(settings.max_depth);
        const MisHeuristic heuristic = mis_heuristic(settings.mis);
        while (const auto round = work.take(context)) {
            Film& film = *work.unit().film;
            const bool whole = sample_round(scene, film, *round, static_cast<std::uint64_t>(settings.seed),
                                            StreamPurpose::bidirectional, context, luminance,
                                            [&](const Vec2& image, SampleSource& source) {
                                                return sample_pixel(scene, image, depth, heuristic, splats, source);
                                            });
            // Of later rounds that are cut short the eye's samples are enough.
            const double share_of_round = whole ? 1 : work.is_first() ? film.samples_per_pixel() : 0;
            if (share_of_round > 0) work.unit().drawn->add(splats, scale / share_of_round);
            splats.clear();
            if (whole) work.end_unit(result.stats);
        }
    }
    report_samples(luminance, result.stats);
    report_lost_light(luminance, scene, result.stats);
    result.picture = work.finish(result.stats);
    return result;
}

} // namespace keyhole
