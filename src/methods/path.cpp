// --method path: path tracing with next-event estimation, the reference.
#include "methods/method.h"
#include "methods/pixel_sink.h"
#include "methods/sample_report.h"
#include "session/pixel_sampling.h"
#include "session/stage_clock.h"
#include "session/work.h"

namespace keyhole {
namespace {

constexpr Stage kPathTracing{"path tracing", &Settings::spp, 1};

RenderResult render_path(const RenderTask& task) {
    const auto& [scene, settings, paths, context, share, findings, observer] = task;
    RenderResult result;
    Work work(settings, scene.camera().window(), AccumulationBuffer::Parts::film, share, settings.spp,
              Work::PassStart::free);
    PixelSampling pixels(scene, settings, share, StreamPurpose::path_tracing);
    {
        const StageClock clock(result.stats, kPathTracing);
        const SamplingStage stage(scene, work.left(), "path tracing", context);
        const auto depth = static_cast<int>(settings.max_depth);
        while (const auto round = work.take(context)) {
            const bool whole =
                pixels.take_round(*work.unit().film, *round, context, [&](const Vec2& image, SampleSource& source) {
                    PixelSink sink{};
                    trace_path(scene, image, depth, source, sink);
                    return sink.pixel;
                });
            if (whole) work.end_unit(result.stats);
        }
    }
    pixels.report(result.stats);
    report_eye_samples(pixels.luminances(), scene, result.stats);
    report_black(pixels.luminances(), scene, result.stats);
    report_lost_caustics(scene, result.stats, true);
    result.picture = work.finish(result.stats);
    return result;
}

} // namespace

constinit const Method methods::path{.name = "path",
                                     .help = "path tracing, the reference",
                                     .samples_pixels = true,
                                     .asks_for_direct_light = true,
                                     .scatters_in_media = true,
                                     .trial = {.share = 0.10, .by_work = true},
                                     .render = render_path};

} // namespace keyhole
