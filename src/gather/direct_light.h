// Direct light at a vertex, visibility included.
#pragma once

#include "sampling/direct_light.h"
#include "sampling/walk.h"

namespace keyhole {

/// The mean of `samples` samples of emitters, which share out the lights and their areas; weighted against a direction
/// of the BSDF that the caller traces [W/(m^2 sr)].
Rgb next_event(const Scene& scene, const Vertex& v, const Vec3& back, int samples, SampleSource& source);

/// What a direction drawn from the BSDF meets of emitters, weighted against next_event(): `visit(const SurfacePoint&
/// emitter, const Rgb& value)` if it carries anything.
template <class Visit>
void sample_emission(const Scene& scene, const Vertex& v, const Vec3& back, SampleSource& source, const Visit& visit) {
    const auto next = continue_walk(v, back, From::eye, source);
    if (!next || is_specular(next->event)) return;
    const auto hit = next_vertex(scene, v, next->w);
    if (!hit || !hit->point.is_emitter()) return;
    visit(hit->point, next->weight * scene.transmittance(v.point, hit->point) *
                          emission_with_mis(scene, v, *hit, next->w, next->pdf));
}

/// Both techniques: `samples` samples of emitters and one of the BSDF [W/(m^2 sr)].
Rgb direct_light(const Scene& scene, const Vertex& v, const Vec3& back, int samples, SampleSource& source);

} // namespace keyhole
