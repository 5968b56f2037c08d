// Direct light at a vertex, visibility included.
#pragma once

#include "sampling/paths/direct_light.h"
#include "sampling/paths/walk.h"

namespace keyhole {

/// Direct light that `v` reflects towards `back` [W/(m^2 sr)], by next-event estimation: the mean of `samples`
/// stratified samples of emitters, MIS-weighted against a direction of the BSDF, which the caller traces: by
/// sample_emission(), or as a gather ray.
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

/// Direct light that `v` reflects towards `back` [W/(m^2 sr)], by both techniques, weighted against each other: the
/// mean of `samples` stratified samples of emitters (next_event()), and one sample of the BSDF (sample_emission()).
Rgb direct_light(const Scene& scene, const Vertex& v, const Vec3& back, int samples, SampleSource& source);

} // namespace keyhole
