// The independent estimators that stage one can use, behind one interface.
#pragma once

#include "sampling/paths/bidirectional_tracer.h"
#include "sampling/paths/path_tracer.h"

#include <cstdint>

namespace keyhole {

enum class Technique {
    path,          ///< path tracing with next-event estimation: cheap
    bidirectional, ///< bidirectional path tracing: finds light that path tracing meets by chance only
};

/// Density with which a sample of bidirectional path tracing makes a measured path, by any number of vertices from the
/// light, in the convention of measure.h. Roulette counts as survived.
double bidirectional_density(const Path& path);

/// Tells `sink` of the paths of a set that trace_path() completes.
template <class Sink> struct CompletePaths {
    using LooksThroughGlass = std::true_type;

    const Scene& scene;
    const Vec2& image;
    const PathSet& set;
    Sink& sink;

    static bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }
    void contribution(EyeWalk& walk, const Vertex& x0, const Rgb& value, LightClass light) {
        const auto covered = [&] { return is_d2_covered(set, walk, x0); };
        if (!set.contains(light, covered)) return;
        sink.contribution(value, ask_stored_kind(light, covered),
                          [&] { return complete_path(scene, walk, x0, image); });
    }
};

/// Traces one sample from window point `image`. Tells `sink`:
///   sink.contribution(value, kind, make_path): an estimate of radiance by a path of `wanted` that make_path() returns,
///     measured, and the PhotonKind that it stores.
template <class Sink>
void trace_independent(Technique technique, const Scene& scene, const Vec2& image, const ConnectionRule& wanted,
                       SampleSource& source, Sink& sink) {
    if (technique == Technique::bidirectional) {
        SubPathPair& pair = trace_both_subpaths(scene, image, wanted.max_scatterings, source, source);
        struct {
            const PathSet& set;
            Sink& sink;
            void contribution(const Connection& connection, const Rgb& value, LightClass light) {
                const auto covered = [&] { return connection.is_d2_covered(set); };
                sink.contribution(value, ask_stored_kind(light, covered), [&] { return connection.path(); });
            }
        } adapter{wanted.set, sink};
        connect_subpaths(scene, pair, image, wanted, adapter);
        return;
    }
    CompletePaths<Sink> paths{scene, image, wanted.set, sink};
    trace_path(scene, image, wanted.max_scatterings, source, paths);
}

} // namespace keyhole
