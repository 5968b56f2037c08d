// Bidirectional path tracing (Veach 1997, chapter 10; Lafortune and Willems 1993): sub-paths from the eye and from the
// light, every pair of their vertices joined, weighted by multiple importance sampling.
#pragma once

#include "core/choices.h"
#include "sampling/paths/measure.h"
#include "sampling/proposals/edit.h"

#include <algorithm>

namespace keyhole {

/// Ratios of densities: of the techniques that make fewer than i of the first vertices of a sub-path, to one that makes
/// i. Their sum, the sum of their squares, and the largest.
struct ShorterTechniques {
    double sum = 0, squares = 0, largest = 0;

    /// The same for one vertex more, whose density from the other end is `ratio` times that from this one. `cut`:
    /// whether there is a technique that makes all but this vertex.
    ShorterTechniques longer(double ratio, bool cut) const {
        if (!(ratio > 0)) return {}; // also where a sum has grown beyond all bounds: 0 times that is 0 here
        const double own = cut ? 1 : 0;
        return {ratio * (own + sum), ratio * ratio * (own + squares), ratio * std::max(own, largest)};
    }
};

/// A sub-path as a walk made it. Its vertices carry the density with which they were traced and, but for the last two,
/// that of the other direction.
struct TracedSubPath {
    SubPath vertices;

    /// What else is known of a vertex.
    struct Note {
        Rgb throughput; ///< contribution over density of what lies before it, scattering there left out, roulette
                        ///< included
        Vec3 back;      ///< unit, towards the vertex before it
        ShorterTechniques shorter; ///< than the one that makes all vertices before it; not of the last vertex
        double flight_back = 1;    ///< flight_density() of the vertex before it, from it
    };
    InlineVector<Note, kMaxScatterings + 2> notes; ///< of each vertex

    int size() const { return static_cast<int>(vertices.size()); }
    void clear() {
        vertices.clear();
        notes.clear();
    }
};

/// One way of joining a light sub-path to an eye sub-path: what the path carries, and its weight among all ways of
/// making it. Costs no copy of the sub-paths: densities change at the two vertices on either side of the connection
/// only. It is the path x that joins the first s vertices of `light` and the first t of `eye`. s = 0: the eye sub-path
/// lies on an emitter. t = 1: the light sub-path is joined to the eye itself, and the image point follows from that. s
/// + t >= 2, t >= 1. Refers to the sub-paths.
class Connection {
  public:
    Connection(const Scene& scene, TracedSubPath& light, int s, TracedSubPath& eye, int t, const Vec2& image);

    int s() const { return s_; }
    int t() const { return t_; }
    /// False where the two can't be joined at all; nothing else may be asked then.
    bool possible() const { return possible_; }
    const Vec2& image() const { return image_; }
    LightClass light_class() const { return keyhole::light_class(diffuse(), first_lit()); }
    const Vertex& vertex(int i) const; ///< of the path, 0 at the light
    /// Whether gather rays come to the path's d2, if it has one; its sub-path keeps the answer.
    bool is_d2_covered(const PathSet& set) const;

    /// Contribution over density times the weight among all techniques. Black where the weight is zero. Visibility is
    /// assumed.
    Rgb value(MisHeuristic heuristic);

    /// Density of the technique that makes k vertices from the light, over that of this one. To be asked after value(),
    /// of a path that carries light.
    double density_ratio(int k) const;

    /// Whether the joining edge is free. True for s = 0.
    bool visible() const;

    /// The path itself, measured.
    Path path() const;

  private:
    DiffuseVertices diffuse() const {
        return find_diffuse(s_ + t_ - 1, [&](int i) { return specular(i); });
    }
    int first_lit() const {
        return keyhole::first_lit(
            s_ + t_ - 1, [&](int i) -> const Vertex& { return vertex(i); }, [&](int i) { return specular(i); });
    }
    bool specular(int i) const { return i != s_ - 1 && i != s_ && vertex(i).specular(); }
    Rgb join();
    Rgb leave_light(const Vec3& to_eye);
    Rgb leave_eye(const Vec3& to_light);
    double weight(MisHeuristic heuristic) const;
    double pdf_from_light(int i) const;
    double pdf_from_eye(int i) const;
    ShorterTechniques shorter_light() const;
    ShorterTechniques shorter_eye() const;

    const Scene* scene_;
    TracedSubPath *light_, *eye_;
    int s_, t_;
    Vec2 image_;
    bool possible_ = false;
    Vec3 to_eye_{0, 0, 0};                   // from x[s - 1] to x[s]; where s > 0
    double from_light_[2]{}, from_eye_[2]{}; // of x[s], x[s + 1] when traced from the light; of x[s - 1], x[s - 2]
};

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

/// Traces both sub-paths of paths with `max_scatterings` at most, in this thread's room. Longer walks are ended by
/// numbers from `roulette`; null: of each by those that it is traced with.
SubPathPair& trace_both_subpaths(const Scene& scene, const Vec2& image, int max_scatterings, SampleSource& from_eye,
                                 SampleSource& from_light, SampleSource* roulette = nullptr);

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
