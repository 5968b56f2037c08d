// The independent estimators that stage one can use, behind one interface.
#pragma once

#include "sampling/bidirectional_tracer.h"
#include "sampling/path_tracer.h"

#include <cstdint>

namespace keyhole {

enum class Technique {
    path,          ///< path tracing with next-event estimation: cheap
    bidirectional, ///< bidirectional path tracing: finds light that path tracing meets by chance only
};

/// Traces one sample from window point `image`. Tells `sink`:
///   sink.arrival(vertex, to_eye, throughput, finite): importance arrived at `vertex` after `finite` non-specular ones;
///   sink.contribution(value, light_class, make_path): an estimate of radiance by a path of `set` that make_path()
///     returns, measured.
template <class Sink>
void trace_independent(Technique technique, const Scene& scene, const Vec2& image, int max_scatterings, PathSet set,
                       SampleSource& source, Sink& sink) {
    if (technique == Technique::bidirectional) {
        auto& [eye, light] = SubPathPair::scratch();
        trace_eye_subpath(scene, image, most_eye_vertices(max_scatterings), source, &source, eye);
        trace_light_subpath(scene, most_light_vertices(max_scatterings), source, &source, light);
        int finite = 0;
        for (std::size_t i = 1; i < eye.vertices.size(); ++i) {
            const Vertex& v = eye.vertices[i];
            if (v.point.site != Site::surface) break;
            sink.arrival(v, direction(v.point, eye.vertices[i - 1].point), eye.throughput[i], finite);
            finite += v.specular() ? 0 : 1;
        }
        struct {
            Sink& sink;
            void contribution(const Joint& joint, const Rgb& value, LightClass light) {
                sink.contribution(value, light, [&] { return joint.path(); });
            }
        } adapter{sink};
        connect_subpaths(scene, light, eye, image, max_scatterings, set, MisHeuristic::power, adapter);
        return;
    }
    struct {
        const Scene& scene;
        const Vec2& image;
        PathSet set;
        Sink& sink;
        bool arrival(const EyeWalk& walk, const Rgb& throughput, int finite) {
            const Vertex& v = walk.back();
            sink.arrival(v, direction(v.point, walk[walk.size() - 2].point), throughput, finite);
            return true;
        }
        void contribution(const EyeWalk& walk, const Vertex& x0, const Rgb& value, LightClass light) {
            if (in_set(light, set))
                sink.contribution(value, light, [&] { return complete_path(scene, walk, x0, image); });
        }
    } adapter{scene, image, set, sink};
    trace_path(scene, image, max_scatterings, source, adapter);
}

} // namespace keyhole
