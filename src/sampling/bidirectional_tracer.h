// Bidirectional path tracing (Veach 1997, chapter 10; Lafortune and Willems 1993): sub-paths from the eye and from the
// light, every pair of their vertices joined, weighted by multiple importance sampling.
#pragma once

#include "sampling/light_class.h"
#include "sampling/measure.h"
#include "sampling/proposals/edit.h"

namespace keyhole {

/// A sub-path as a walk made it.
struct TracedSubPath {
    SubPath vertices;
    InlineVector<double, kMaxScatterings + 2> survival; ///< probability that roulette let the walk reach vertex i
    InlineVector<Rgb, kMaxScatterings + 2>
        throughput; ///< what scattering and media left before vertex i, over survival

    void push_back(const Vertex& v, double survived, const Rgb& arriving) {
        vertices.push_back(v);
        survival.push_back(survived);
        throughput.push_back(arriving);
    }
};

/// The eye's sub-path through window point `image`, [0] the eye, with at most `max_scatterings` further vertices.
TracedSubPath trace_eye_subpath(const Scene& scene, const Vec2& image, int max_scatterings, SampleSource& source);

/// A light sub-path, [0] on an emitter; empty if nothing emits.
TracedSubPath trace_light_subpath(const Scene& scene, int max_scatterings, SampleSource& source);

/// The path that joins the first s vertices of `light` and the first t of `eye`, measured; its image point is `image`
/// unless t = 1. None if they can't be joined, carry nothing, don't see each other or aren't in `set`. s = 0: the eye
/// sub-path lies on an emitter.
std::optional<Path> join_subpaths(const Scene& scene, const SubPath& light, int s, const SubPath& eye, int t,
                                  const Vec2& image, PathSet set);

/// Weight of making a measured path with s vertices from the light: the power heuristic with exponent 2 over all s, and
/// the density of that technique.
struct TechniqueWeight {
    double density, mis;
};
TechniqueWeight technique_weight(const Path& path, int s);

/// Traces one pair of sub-paths and tells sink.contribution(path, value, light_class) about every path of `set` that
/// joins them: `value` is an estimate of radiance at path.image (window density 1), MIS weight included.
template <class Sink>
void connect_subpaths(const Scene& scene, const TracedSubPath& light, const TracedSubPath& eye, const Vec2& image,
                      int max_scatterings, PathSet set, Sink& sink) {
    const int most_s = static_cast<int>(light.vertices.size()), most_t = static_cast<int>(eye.vertices.size());
    for (int t = 1; t <= most_t; ++t) {
        for (int s = 0; s <= most_s && s + t - 2 <= max_scatterings; ++s) {
            if (s + t < 2) continue;
            const auto path = join_subpaths(scene, light.vertices, s, eye.vertices, t, image, set);
            if (!path) continue;
            const TechniqueWeight w = technique_weight(*path, s);
            const double survival = eye.survival[static_cast<std::size_t>(t) - 1] *
                                    (s > 0 ? light.survival[static_cast<std::size_t>(s) - 1] : 1.0);
            if (w.density > 0)
                sink.contribution(*path, path->contribution * (w.mis / (w.density * survival)), light_class(*path));
        }
    }
}

} // namespace keyhole
