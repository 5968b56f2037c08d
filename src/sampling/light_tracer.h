// Light tracing: power carried from the emitters.
#pragma once

#include "sampling/walk.h"

#include <algorithm>

namespace keyhole {

/// Traces one light path with at most `max_scatterings` vertices after the emitter.
///
/// Tells `sink`:
///   sink.arrival(vertex, to_light, power, specular_only): light of RGB `power` [W] arrived at `vertex`, which lies on
///   a
///     surface, from direction `to_light` (unit); `specular_only`: it met nothing but specular vertices, at least one,
///     since it left the emitter. False ends the path.
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
    bool diffused = false, bent = false;
    for (int scatterings = 1; scatterings <= max_scatterings && !is_black(power); ++scatterings) {
        const auto hit = next_vertex(scene, v, w);
        if (!hit || hit->point.site == Site::infinite) return;
        power *= scene.transmittance(v.point, hit->point);
        v = *hit;
        if (!sink.arrival(v, -w, power, bent && !diffused)) return;
        const auto next = continue_walk(v, -w, From::light, source);
        if (!next) return;
        (is_specular(next->event) ? bent : diffused) = true;
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
