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

/// Density with which a sample of bidirectional path tracing makes a measured path, by any number of vertices from the
/// light, in the convention of measure.h. Roulette counts as survived.
double bidirectional_density(const Path& path);

/// What a path of class `light` stores; `reached()`: whether gather rays come to its d2.
template <class Reached> PhotonKind stored_kind(LightClass light, const PathSet& set, const Reached& reached) {
    switch (light) {
    case LightClass::caustic:
        return PhotonKind::caustic;
    case LightClass::indirect:
        return set.reach == nullptr || reached() ? PhotonKind::global : PhotonKind::caustic;
    case LightClass::second:
        return set.reach == nullptr || reached() ? PhotonKind::none : PhotonKind::caustic;
    default:
        return PhotonKind::none;
    }
}

/// Traces one sample from window point `image`. Tells `sink`:
///   sink.arrival(vertex, to_eye, throughput, finite): importance arrived at `vertex` after `finite` non-specular ones;
///   sink.contribution(value, kind, make_path): an estimate of radiance by a path of `set` that make_path() returns,
///     measured, and the PhotonKind that it stores.
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
            sink.arrival(v, eye.notes[i].back, eye.notes[i].throughput, finite);
            finite += v.specular() ? 0 : 1;
        }
        struct {
            const PathSet& set;
            Sink& sink;
            void contribution(const Joint& joint, const Rgb& value, LightClass light) {
                const auto reached = [&] {
                    const int d2 = joint.nth_finite_from_eye(2);
                    return set.reaches(joint.vertex(d2).point, joint.vertex(d2 - 1).point);
                };
                sink.contribution(value, stored_kind(light, set, reached), [&] { return joint.path(); });
            }
        } adapter{set, sink};
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
            if (!in_set(light, set, walk.back().point, x0.point)) return;
            sink.contribution(value, stored_kind(light, set, [&] { return reaches_d2(set, walk, x0); }),
                              [&] { return complete_path(scene, walk, x0, image); });
        }
    } adapter{scene, image, set, sink};
    trace_path(scene, image, max_scatterings, source, adapter);
}

} // namespace keyhole
