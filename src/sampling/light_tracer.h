// Light tracing: power carried from the emitters.
#pragma once

#include "sampling/walk.h"

#include <algorithm>
#include <optional>

namespace keyhole {

/// What light met before it arrived somewhere.
struct LightPast {
    struct Place {
        Vec3 p, n; ///< world space; geometric normal on the side where light arrived
    };
    std::optional<Place> last; ///< where it was last scattered by a vertex that isn't specular; none: nowhere
    bool specular = false;     ///< whether there was a specular one
    int scatterings = 0;       ///< how many vertices scattered it

    /// Light that comes from `to_light` goes on from `v` by its event.
    void meet(const Vertex& v, const Vec3& to_light) {
        ++scatterings;
        if (v.specular())
            specular = true;
        else
            last = {v.point.p, facing(v.point.ng, to_light)};
    }

    /// It met nothing but specular vertices, at least one.
    bool specular_only() const { return specular && !last; }
};

/// Traces one light path with at most `max_scatterings` vertices after the emitter.
///
/// Tells `sink`:
///   sink.arrival(vertex, to_light, power, past): light of RGB `power` [W] arrived at `vertex`, which lies on
///     a surface, from direction `to_light` (unit); `past`: a LightPast. False ends the path.
/// The expected sum of power over the arrivals in a region is the flux that arrives there.
template <class Sink> void trace_light_path(const Scene& scene, int max_scatterings, SampleSource& source, Sink& sink) {
    const auto start = sample_emitter(scene, source);
    if (!start || !(start->pdf > 0)) return;
    Vertex v = start->vertex;
    const Emitter& emitter = scene.emitter(v.point.emitter);
    const EmitterRay ray = emitter.sample_ray(v.point, source);
    if (!(ray.pdf > 0)) return;
    Rgb power = emitter.radiance(v.point, ray.w) * (v.point.abs_cos(ray.w) / (start->pdf * ray.pdf));
    v.point = ray.origin;
    Vec3 w = ray.w;
    const double emitted = luminance(power);
    LightPast past;
    for (int scatterings = 1; scatterings <= max_scatterings && !is_black(power); ++scatterings) {
        const auto hit = next_vertex(scene, v, w);
        if (!hit || hit->point.site == Site::infinite) return;
        // From where light sets out: it may have come from infinity.
        power *= scene.transmittance(scatterings == 1 ? start->vertex.point : v.point, hit->point);
        v = *hit;
        if (!sink.arrival(v, -w, power, past)) return;
        const auto next = continue_walk(v, -w, From::light, source);
        if (!next) return;
        v.event = next->event;
        past.meet(v, -w);
        power *= next->weight;
        // Roulette keeps the power of surviving photons near that which was emitted.
        const double survive = std::min(1.0, luminance(power) / emitted);
        if (survive < 1) {
            if (source.next() >= survive) return;
            power /= survive;
        }
        w = next->w;
    }
}

} // namespace keyhole
