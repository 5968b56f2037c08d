// --method path
#include "render/methods.h"
#include "render/pixel_sink.h"
#include "render/pixels.h"
#include "render/sample_report.h"
#include "render/stage_clock.h"
#include "render/work.h"

namespace keyhole {

RenderResult render_path(const Scene& scene, const Settings& settings, const RunContext& context, const Share& share) {
    RenderResult result;
    RunningStats luminance;
    Work work(settings, scene.camera().window(), Exposure::Parts::film, share, settings.spp, Work::PassStart::free);
    {
        const StageClock clock(result.stats, "path tracing");
        const SamplingStage stage(scene, work.left(), "path tracing", context);
        const auto depth = static_cast<int>(settings.max_depth);
        while (const auto round = work.take(context)) {
            const bool whole = sample_round(scene, *work.unit().film, *round, static_cast<std::uint64_t>(settings.seed),
                                            StreamPurpose::path_tracing, *round == 0 ? context.first_round() : context,
                                            luminance, [&](const Vec2& image, SampleSource& source) {
                                                PixelSink sink{};
                                                trace_path(scene, image, depth, source, sink);
                                                return sink.pixel;
                                            });
            if (whole) work.end_unit(result.stats);
        }
    }
    report_eye_samples(luminance, scene, result.stats);
    report_lost_light(luminance, scene, result.stats);
    result.picture = work.finish(result.stats);
    return result;
}

} // namespace keyhole
