// --method bdpt: bidirectional path tracing. Paths whose light sub-path is joined to the eye itself choose their pixel;
// all others belong to the pixel that the eye sub-path was traced for.
#include "film/splats.h"
#include "render/methods.h"
#include "render/mis_heuristic.h"
#include "render/pixel_sink.h"
#include "render/pixels.h"
#include "render/stage_clock.h"
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
    for (std::size_t i = 1; i < eye.vertices.size() && !pixel.saw_surface(); ++i)
        pixel.see(eye.vertices[i], eye.vertices[i - 1], i == 1);
    BidirectionalSink sink{pixel, splats, scene.camera().window()};
    connect_subpaths(scene, light, eye, image, depth, PathSet::all, heuristic, sink);
    return pixel.pixel;
}

} // namespace

RenderResult render_bdpt(const Scene& scene, const Settings& settings, const RunContext& context) {
    RenderResult result;
    const ImageWindow& window = scene.camera().window();
    Film film(window.width, window.height, PixelFilter(settings));
    SplatFilm splats(window.width, window.height, PixelFilter(settings));
    std::int64_t rounds = 0;
    {
        const StageClock clock(result.stats, "bidirectional path tracing");
        const auto depth = static_cast<int>(settings.max_depth);
        const MisHeuristic heuristic = mis_heuristic(settings.mis);
        rounds = sample_pixels(scene, film, settings.spp, static_cast<std::uint64_t>(settings.seed), StreamPurpose::bidirectional,
                               "bidirectional path tracing", context, [&](const Vec2& image, SampleSource& source) {
                                   return sample_pixel(scene, image, depth, heuristic, splats, source);
                               });
        result.stats.complete = rounds == settings.spp;
    }
    film.report(result.stats);
    result.picture = film.to_picture();
    // One light sub-path for each pixel and round, each an estimate of the whole window.
    const double light_subpaths = static_cast<double>(window.width) * window.height * static_cast<double>(rounds);
    if (rounds > 0) splats.add_to(result.picture, window.pixels() / light_subpaths);
    return result;
}

} // namespace keyhole
