// Bidirectional path tracing (Veach 1997, chapter 10; Lafortune and Willems 1993): sub-paths from the eye and from the
// light, every pair of their vertices joined, weighted by multiple importance sampling.
#pragma once

#include "sampling/bidirectional_joint.h"

namespace keyhole {

/// Most vertices that the sub-paths of paths with `max_scatterings` need.
inline int most_eye_vertices(int max_scatterings) { return std::min(max_scatterings, kMaxScatterings) + 2; }
inline int most_light_vertices(int max_scatterings) { return std::min(max_scatterings, kMaxScatterings) + 1; }

/// The eye's sub-path through window point `image` into `walk`, [0] the eye, with at most `most_vertices`. Longer walks
/// are ended by numbers from `roulette`; null: they are not.
void trace_eye_subpath(const Scene& scene, const Vec2& image, int most_vertices, SampleSource& source,
                       SampleSource* roulette, TracedSubPath& walk);

/// A light sub-path into `walk`, [0] on an emitter, with at most `most_vertices`; empty if nothing emits.
void trace_light_subpath(const Scene& scene, int most_vertices, SampleSource& source, SampleSource* roulette,
                         TracedSubPath& walk);

/// Room for two sub-paths: to make such a thing anew costs as much as to trace a ray. Each thread has two of them.
struct SubPathPair {
    TracedSubPath eye, light;
    static SubPathPair& scratch(std::size_t room = 0);
};

/// Joins every pair of vertices of two sub-paths and tells sink.contribution(connection, value, light_class) about
/// every path of `set` among them with at most `max_scatterings`: `connection` is a Joint at connection.image() (window
/// point), `value` an estimate of radiance there (window density 1), MIS weight included. `image` is that of the eye
/// sub-path.
template <class Sink>
void connect_subpaths(const Scene& scene, const TracedSubPath& light, const TracedSubPath& eye, const Vec2& image,
                      int max_scatterings, PathSet set, MisHeuristic heuristic, Sink& sink) {
    const int most_s = light.size(), most_t = eye.size();
    for (int t = 1; t <= most_t; ++t) {
        for (int s = 0; s <= most_s && s + t - 2 <= max_scatterings; ++s) {
            if (s + t < 2) continue;
            Joint joint(scene, light, s, eye, t, image);
            if (!joint.possible()) continue;
            const Rgb value = joint.value(heuristic);
            if (!(luminance(value) > 0)) continue;
            const LightClass kind = joint.light_class();
            if (in_set(kind, set, joint.vertex(1).point, joint.vertex(0).point) && joint.visible())
                sink.contribution(joint, value, kind);
        }
    }
}

} // namespace keyhole
