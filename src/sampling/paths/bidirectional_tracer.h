// Bidirectional path tracing (Veach 1997, chapter 10; Lafortune and Willems 1993): sub-paths from the eye and from the
// light, every pair of their vertices joined, weighted by multiple importance sampling.
#pragma once

#include "sampling/paths/bidirectional_connection.h"

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

/// Which paths are to be made of two sub-paths, and how techniques share them.
struct ConnectionRule {
    int max_scatterings;
    PathSet set = PathSet::all;
    MisHeuristic heuristic = MisHeuristic::power;
};

/// Joins every pair of vertices of two sub-paths and tells sink.contribution(connection, value, light_class) about
/// every path among them that `rule` asks for: `connection` is a Connection at connection.image()
/// (window point), `value` an estimate of radiance there (window density 1), MIS weight included. `image` is that of
/// the eye sub-path.
template <class Sink>
void connect_subpaths(const Scene& scene, SubPathPair& pair, const Vec2& image, const ConnectionRule& rule,
                      Sink& sink) {
    auto& [eye, light] = pair;
    const int most_s = light.size(), most_t = eye.size();
    for (int t = 1; t <= most_t; ++t) {
        for (int s = 0; s <= most_s && s + t - 2 <= rule.max_scatterings; ++s) {
            if (s + t < 2) continue;
            Connection connection(scene, light, s, eye, t, image);
            if (!connection.possible()) continue;
            const Rgb value = connection.value(rule.heuristic);
            if (!(luminance(value) > 0)) continue;
            const LightClass kind = connection.light_class();
            const auto covered = [&] { return connection.is_d2_covered(rule.set); };
            if (rule.set.contains(kind, covered) && connection.visible()) sink.contribution(connection, value, kind);
        }
    }
}

} // namespace keyhole
