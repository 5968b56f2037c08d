// Direct light at a vertex, visibility included.
#pragma once

#include "sampling/direct_light.h"
#include "sampling/walk.h"

namespace keyhole {

/// One sample of an emitter, weighted against a direction of the BSDF that the caller traces [W/(m^2 sr)].
Rgb next_event(const Scene& scene, const Vertex& v, const Vec3& back, SampleSource& source);

/// One sample of either technique: `visit(const SurfacePoint& emitter, const Rgb& value, bool visible)` for each that
/// carries anything, `value` being what it scatters towards `back` if nothing stands in between.
template <class Visit>
void sample_both_techniques(const Scene& scene, const Vertex& v, const Vec3& back, SampleSource& source,
                            const Visit& visit) {
    if (const auto light = sample_direct_light(scene, v, back, source))
        visit(light->x0.point, light->value, scene.visible(v.point, light->x0.point));
    const auto next = continue_walk(v, back, From::eye, source);
    if (!next || is_specular(next->event)) return;
    const auto hit = next_vertex(scene, v, next->w);
    if (!hit || !hit->point.is_emitter()) return;
    visit(hit->point,
          next->weight * scene.transmittance(v.point, hit->point) *
              emission_with_mis(scene, v, *hit, next->w, next->pdf),
          true);
}

/// Both techniques, one sample each [W/(m^2 sr)].
Rgb direct_light(const Scene& scene, const Vertex& v, const Vec3& back, SampleSource& source);

} // namespace keyhole
