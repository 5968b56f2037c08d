// --method path
#include "render/methods.h"
#include "render/pixel_sink.h"
#include "render/pixels.h"
#include "render/stage_clock.h"

namespace keyhole {

RenderResult render_path(const Scene& scene, const Settings& settings, const RunContext& context) {
    RenderResult result;
    Film film(scene.camera().window().width, scene.camera().window().height, PixelFilter(settings));
    {
        const StageClock clock(result.stats, "path tracing");
        const auto depth = static_cast<int>(settings.max_depth);
        const auto rounds = sample_pixels(scene, film, settings.spp, static_cast<std::uint64_t>(settings.seed),
                                          StreamPurpose::path_tracing, "path tracing", context,
                                          [&](const Vec2& image, SampleSource& source) {
                                              PixelSink sink{};
                                              trace_path(scene, image, depth, source, sink);
                                              return sink.pixel;
                                          });
        result.stats.complete = rounds == settings.spp;
    }
    film.report(result.stats);
    result.picture = film.to_picture();
    return result;
}

} // namespace keyhole
