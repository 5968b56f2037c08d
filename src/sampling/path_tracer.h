// Path tracing with next-event estimation: the reference method, and stage one.
#pragma once

#include "sampling/direct_light.h"
#include "sampling/light_class.h"
#include "sampling/measure.h"
#include "sampling/walk.h"

namespace keyhole {

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

/// As PathSet::reaches(), of the path that joins a walk with a d2 to emitter vertex x0.
inline bool reaches_d2(const PathSet& set, const EyeWalk& walk, const Vertex& x0) {
    std::size_t d2 = 1;
    for (int finite = 0; d2 + 1 < walk.size(); ++d2)
        if (!walk[d2].specular() && ++finite == 2) break;
    return set.reaches(walk[d2].point, d2 + 1 < walk.size() ? walk[d2 + 1].point : x0.point);
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
        throughput *= scene.transmittance(walk.back().point, hit->point);
        if (hit->point.is_emitter()) {
            const bool after_specular = scatterings == 0 || walk.back().specular();
            const Rgb emitted = after_specular ? scene.emitter(hit->point.emitter).radiance(hit->point, -w)
                                               : emission_with_mis(scene, walk.back(), *hit, w, pdf);
            const LightClass light = finite == 0      ? LightClass::emission
                                     : finite >= 3    ? LightClass::indirect
                                     : finite == 2    ? (after_specular ? LightClass::indirect : LightClass::second)
                                     : after_specular ? LightClass::caustic
                                                      : LightClass::direct;
            if (!is_black(emitted)) sink.contribution(walk, *hit, throughput * emitted, light);
        }
        if (scatterings == max_scatterings || hit->point.site == Site::infinite) return;
        walk.push_back(*hit);
        if (!sink.arrival(walk, throughput, finite)) return;

        Vertex& v = walk.back();
        const Vec3 back = -w;
        if (v.bsdf.traits().finite) {
            v.event = Event::finite;
            const auto light = sample_direct_light(scene, v, back, source);
            if (light && scene.visible(v.point, light->x0.point))
                sink.contribution(walk, light->x0, throughput * light->value,
                                  finite == 0   ? LightClass::direct
                                  : finite == 1 ? LightClass::second
                                                : LightClass::indirect);
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
