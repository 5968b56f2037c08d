// Path tracing with next-event estimation: the reference method, and stage one.
#pragma once

#include "sampling/measure.h"
#include "sampling/walk.h"

namespace keyhole {

/// What light did before it reached the eye, by the vertices that are not specular.
enum class LightClass {
    emission, ///< L S* E
    direct,   ///< L D S* E
    caustic,  ///< L S+ D S* E
    indirect, ///< two or more D
};

/// Vertices of a walk from the eye: [0] is the eye.
using EyeWalk = InlineVector<Vertex, kMaxScatterings + 2>;

/// Survival probability of a walk with this throughput: roulette begins once a walk is long enough to matter less.
inline double survival_probability(const Rgb& throughput, int scatterings) {
    if (scatterings < 4) return 1;
    return std::clamp(std::max({throughput.x, throughput.y, throughput.z}), 0.05, 0.95);
}

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

/// Power heuristic with exponent 2 of a technique against one other (Veach 1997, eq. 9.13).
inline double mis_power(double pdf, double other) {
    if (!(pdf > 0)) return 0;
    const double r = other / pdf;
    return 1 / (1 + r * r);
}

/// Next-event estimation at the last vertex of the walk.
template <class Sink>
void next_event(const Scene& scene, const EyeWalk& walk, const Vec3& back, const Rgb& throughput, LightClass light,
                SampleSource& source, Sink& sink) {
    const auto x0 = sample_emitter(scene, source);
    if (!x0 || !(x0->pdf > 0)) return;
    const Vertex& v = walk.back();
    const Vec3 to_light = direction(v.point, x0->vertex.point);
    const ScatterValue s = scatter(v.point, v.bsdf, Event::finite, to_light, back);
    const Emitter& emitter = scene.emitter(x0->vertex.point.emitter);
    const Rgb value = throughput * s.value * emitter.radiance(x0->vertex.point, -to_light) *
                      (geometry_term(v.point, x0->vertex.point) / x0->pdf);
    if (is_black(value)) return;
    const double weight =
        emitter.is_delta() ? 1.0
                           : mis_power(x0->pdf, solid_angle_to_area(s.pdf_to_light, v.point, x0->vertex.point));
    if (!scene.visible(v.point, x0->vertex.point)) return;
    sink.contribution(walk, x0->vertex, value * weight, light);
}

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
    walk.push_back(sample_eye(scene, source));
    Vec3 w = scene.camera().ray_direction(walk[0].point, image);
    Rgb throughput(1.0);
    int finite = 0;
    double pdf = 0; // of w, if the last vertex could also have asked an emitter directly

    for (int scatterings = 0;; ++scatterings) {
        const auto hit = next_vertex(scene, walk.back(), w);
        if (!hit) return;
        if (hit->point.is_emitter()) {
            const Rgb emitted = scene.emitter(hit->point.emitter).radiance(hit->point, -w);
            if (!is_black(emitted)) {
                const bool after_specular = scatterings == 0 || walk.back().specular();
                const double weight = after_specular ? 1.0
                                                     : mis_power(solid_angle_to_area(pdf, walk.back().point, hit->point),
                                                                 emitter_point_pdf(scene, hit->point));
                const LightClass light = finite == 0       ? LightClass::emission
                                         : finite >= 2     ? LightClass::indirect
                                         : after_specular  ? LightClass::caustic
                                                           : LightClass::direct;
                sink.contribution(walk, *hit, throughput * emitted * weight, light);
            }
        }
        if (scatterings == max_scatterings) return;
        walk.push_back(*hit);
        if (!sink.arrival(walk, throughput, finite)) return;

        Vertex& v = walk.back();
        const Vec3 back = -w;
        if (v.bsdf.traits().finite) {
            v.event = Event::finite;
            const LightClass light = finite == 0 ? LightClass::direct : LightClass::indirect;
            next_event(scene, walk, back, throughput, light, source, sink);
        }
        const auto next = continue_walk(v, back, From::eye, source);
        if (!next) return;
        v.event = next->event;
        finite += is_specular(next->event) ? 0 : 1;
        throughput *= next->weight;
        const double survive = survival_probability(throughput, scatterings);
        if (survive < 1) {
            if (source.next() >= survive) return;
            throughput /= survive;
        }
        w = next->w;
        pdf = next->pdf;
    }
}

} // namespace keyhole
