// Path tracing with next-event estimation: the reference method, and stage one.
#pragma once

#include "core/kronecker.h"
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
    /// Of that path.
    LightClass light_class(const Vertex& x0) const {
        const auto at = [&](int i) -> const Vertex& {
            return i == 0 ? x0 : (*this)[size() - static_cast<std::size_t>(i)];
        };
        const int lit = first_lit(static_cast<int>(size()), at, [&](int i) { return at(i).specular(); });
        return keyhole::light_class(diffuse(), lit);
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
    std::size_t last_finite = 0; ///< 0: there is none
    double pdf = 0;              ///< with which that drew the direction in which the walk went on
    StraightLight view{};        ///< from there on
    bool of_each = kTakesEachEmitter && scene.takes_each_emitter();

    /// Whether emitters are sampled through clear glass, too.
    static constexpr bool kLooksThroughGlass = requires { typename Sink::LooksThroughGlass; };
    /// Whether the first surface may have a sample of each emitter.
    static constexpr bool kTakesEachEmitter = requires { typename Sink::TakesEachEmitter; };

    Vertex& place() { return walk.emplace_back(); }
    int scatterings() const { return static_cast<int>(walk.size()) - 2; } // before the last vertex

    bool arrive(Vertex& v, const WalkRay& ray) {
        if (v.point.is_emitter()) add_emission(ray);
        if (scatterings() == max_scatterings || v.point.site == Site::infinite) return false;
        if (!sink.arrival(walk, ray.throughput, walk.finite)) return false;
        if (v.bsdf.traits().finite) add_direct_light(v, ray);
        return true;
    }
    bool leave(const Vertex& v, const Continuation& next, const WalkRay& ray) {
        if (v.specular()) {
            view.meet(v, ray.w);
            return true;
        }
        walk.count_last();
        last_finite = walk.size() - 1;
        pdf = next.pdf;
        view = {};
        return true;
    }
    bool survives(Rgb& throughput, SampleSource& numbers) const {
        return play_roulette(eye_survival(throughput, scatterings()), throughput, numbers);
    }

  private:
    bool is_straight(const Vertex& x0, const Vec3& w) const {
        return view.straight(w, x0.point.site == Site::infinite);
    }
    void add_emission(const WalkRay& ray) {
        const Vertex x0 = walk.back();
        walk.pop_back();
        const bool sampled =
            last_finite > 0 && (last_finite + 1 == walk.size() || (kLooksThroughGlass && is_straight(x0, ray.w)));
        const Rgb emitted =
            sampled ? emission_with_mis(scene, walk[last_finite], x0, ray.w, pdf, last_finite == walk.d1 && of_each)
                    : scene.emitter(x0.point.emitter).radiance(x0.point, -ray.w);
        if (!is_black(emitted)) sink.contribution(walk, x0, ray.throughput * emitted, walk.light_class(x0));
        walk.push_back(x0);
    }
    void add_direct_light(const Vertex& v, const WalkRay& ray) {
        if (walk.finite > 0 || !of_each) return add_light(v, ray, sample_direct_light(scene, v, -ray.w, source));
        SharedNumbers numbers(source);
        for (std::uint32_t i = 0; i < scene.emitters().size(); ++i) {
            numbers.begin(i);
            add_light(v, ray, sample_light_of(scene, i, v, -ray.w, numbers));
        }
    }
    void add_light(const Vertex& v, const WalkRay& ray, const std::optional<DirectLight>& light) {
        if (!light) return;
        walk.count_last();
        const std::size_t end = walk.size();
        const int most_faces = kLooksThroughGlass ? max_scatterings - scatterings() - 1 : 0;
        const Rgb clear = straight_transmittance(scene, v.point, light->x0.point, most_faces,
                                                 [&](const Vertex& glass) { walk.push_back(glass); });
        if (!is_black(clear))
            sink.contribution(walk, light->x0, ray.throughput * clear * light->value, walk.light_class(light->x0));
        while (walk.size() > end) walk.pop_back();
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
///     included, by the path that joins the walk to emitter vertex x0; of a sink with a type LooksThroughGlass next to
///     vertices in clear glass that the emitter was sampled through, which the walk ends with. One with a type
///     TakesEachEmitter is told of several emitters at the first surface that is not specular.
template <class Sink>
void trace_path(const Scene& scene, const Vec2& image, int max_scatterings, SampleSource& source, Sink& sink) {
    EyeWalk walk;
    Vertex& eye = walk.emplace_back();
    sample_eye(scene, source, eye);
    PathTracing<Sink> tracing{{}, scene, max_scatterings, source, sink, walk};
    random_walk(scene, From::eye, eye_ray(scene, eye.point, image), max_scatterings + 1, source, tracing);
}

} // namespace keyhole
