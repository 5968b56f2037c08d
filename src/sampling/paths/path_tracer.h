// Path tracing with next-event estimation: the reference method, and stage one.
#pragma once

#include "sampling/paths/direct_light.h"
#include "sampling/paths/measure.h"
#include "sampling/paths/random_walk.h"

namespace keyhole {

/// Vertices of a walk from the eye: [0] is the eye.
struct EyeWalk : InlineVector<Vertex, kMaxScatterings + 2> {
    int finite = 0;             ///< non-specular vertices whose event is chosen
    std::size_t d1 = 0, d2 = 0; ///< the first two of them; 0: there is none

    /// The event of the last vertex is finite.
    void count_last() {
        if (++finite <= 2) (finite == 1 ? d1 : d2) = size() - 1;
    }
    /// It was not, after all.
    void discount_last() {
        if (--finite < 2) (finite == 0 ? d1 : d2) = 0;
    }
    /// Those of the path that joins the walk to an emitter vertex.
    DiffuseVertices diffuse() const {
        const auto from_light = [&](std::size_t i) { return i > 0 ? static_cast<int>(size() - i) : 0; };
        return {from_light(d1), from_light(d2)};
    }
};

/// The complete path of an eye walk and the emitter vertex x0 beyond its end, measured.
inline Path complete_path(const Scene& scene, const EyeWalk& walk, const Vertex& x0, const Vec2& image) {
    Path path;
    path.image = image;
    path.x.push_back(x0);
    path.x.back().event = Event::finite;
    for (std::size_t i = walk.size(); i-- > 0;) path.x.push_back(walk[i]);
    measure(scene, path);
    return path;
}

/// Whether gather rays come to d2 of the path that joins a walk with one to emitter vertex x0; the walk keeps the
/// answer.
inline bool is_d2_covered(const PathSet& set, EyeWalk& walk, const Vertex& x0) {
    Vertex& d2 = walk[walk.d2];
    const SurfacePoint& before = walk.d2 + 1 < walk.size() ? walk[walk.d2 + 1].point : x0.point;
    return is_covered(set.coverage, d2, direction(d2.point, before));
}

/// The hooks of trace_path().
template <class Sink> struct PathTracing : WalkHooks {
    const Scene& scene;
    const int max_scatterings;
    SampleSource& source;
    Sink& sink;
    EyeWalk& walk;
    double pdf = 0; ///< of the ray

    Vertex& place() { return walk.emplace_back(); }
    int scatterings() const { return static_cast<int>(walk.size()) - 2; } // before the last vertex

    bool arrive(Vertex& v, const WalkRay& ray) {
        if (v.point.is_emitter()) add_emission(ray);
        if (scatterings() == max_scatterings || v.point.site == Site::infinite) return false;
        if (!sink.arrival(walk, ray.throughput, walk.finite)) return false;
        if (v.bsdf.traits().finite) add_direct_light(v, ray);
        return true;
    }
    bool leave(const Vertex& v, const Continuation& next, const WalkRay& /*ray*/) {
        if (!v.specular()) walk.count_last();
        pdf = next.pdf;
        return true;
    }
    bool survives(Rgb& throughput, SampleSource& numbers) const {
        return play_roulette(eye_survival(throughput, scatterings()), throughput, numbers);
    }

  private:
    void add_emission(const WalkRay& ray) {
        const Vertex x0 = walk.back();
        walk.pop_back();
        const bool chosen_by_bsdf_alone = walk.size() == 1 || walk.back().specular();
        const Rgb emitted = chosen_by_bsdf_alone ? scene.emitter(x0.point.emitter).radiance(x0.point, -ray.w)
                                                 : emission_with_mis(scene, walk.back(), x0, ray.w, pdf);
        if (!is_black(emitted)) sink.contribution(walk, x0, ray.throughput * emitted, light_class(walk.diffuse()));
        walk.push_back(x0);
    }
    void add_direct_light(const Vertex& v, const WalkRay& ray) {
        const auto light = sample_direct_light(scene, v, -ray.w, source);
        if (!light || !scene.visible(v.point, light->x0.point)) return;
        walk.count_last();
        sink.contribution(walk, light->x0, ray.throughput * light->value, light_class(walk.diffuse()));
        walk.discount_last();
    }
};

/// Traces one path from `image` (window point), with at most `max_scatterings` vertices between light and eye.
///
/// Tells `sink`:
///   sink.arrival(walk, throughput, finite): the walk reached its last vertex, whose event is not yet chosen, after
///     `finite` non-specular ones; `throughput` is the RGB importance that arrives there (window density 1). False ends
///     the walk.
///   sink.contribution(walk, x0, value, light_class): `value` is an estimate of radiance at the image point, MIS weight
///     included, by the path that joins the walk to emitter vertex x0.
template <class Sink>
void trace_path(const Scene& scene, const Vec2& image, int max_scatterings, SampleSource& source, Sink& sink) {
    EyeWalk walk;
    Vertex& eye = walk.emplace_back();
    sample_eye(scene, source, eye);
    PathTracing<Sink> tracing{{}, scene, max_scatterings, source, sink, walk};
    random_walk(scene, From::eye, eye_ray(scene, eye.point, image), max_scatterings + 1, source, tracing);
}

} // namespace keyhole
