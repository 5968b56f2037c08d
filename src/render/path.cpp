// --method path
#include "render/methods.h"
#include "render/pixels.h"
#include "render/stage_clock.h"
#include "sampling/path_tracer.h"

namespace keyhole {
namespace {

/// Sorts what a path brings into the layers of a pixel.
struct PixelSink {
    PixelSample pixel;

    bool arrival(const EyeWalk& walk, const Rgb& /*throughput*/, int finite) {
        const Vertex& v = walk.back();
        if (walk.size() == 2) pixel.depth = Vec3(v.point.p - walk[0].point.p).length();
        if (finite == 0 && v.bsdf.traits().finite && pixel.normal.length2() == 0) {
            const Vec3 back = direction(v.point, walk[walk.size() - 2].point);
            const Vec3 n = v.bsdf.shading_normal();
            const Vec3 facing = n.dot(back) < 0 ? -n : n;
            pixel.normal = facing;
            pixel.albedo = v.bsdf.eval(facing, back) * kPi;
        }
        return true;
    }

    void contribution(const EyeWalk& /*walk*/, const Vertex& /*x0*/, const Rgb& value, LightClass light) {
        switch (light) {
        case LightClass::emission:
        case LightClass::direct:
            pixel.direct += value;
            break;
        case LightClass::caustic:
            pixel.caustic += value;
            break;
        case LightClass::second:
        case LightClass::indirect:
            pixel.indirect += value;
            break;
        }
    }
};

} // namespace

RenderResult render_path(const Scene& scene, const Settings& settings, const RunContext& context) {
    RenderResult result;
    Film film(scene.camera().window().width, scene.camera().window().height);
    {
        const StageClock clock(result.stats, "path tracing");
        const auto depth = static_cast<int>(settings.max_depth);
        const auto rounds = sample_pixels(scene, film, settings.spp, static_cast<std::uint64_t>(settings.seed),
                                          StreamPurpose::path_tracing, "path tracing", context,
                                          [&](const Vec2& image, SampleSource& source) {
                                              PixelSink sink;
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
