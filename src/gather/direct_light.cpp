#include "gather/direct_light.h"

#include "sampling/direct_light.h"

namespace keyhole {

Rgb next_event(const Scene& scene, const Vertex& v, const Vec3& back, SampleSource& source) {
    const auto light = sample_direct_light(scene, v, back, source);
    return light && scene.visible(v.point, light->x0.point) ? light->value : Rgb(0.0);
}

Rgb direct_light(const Scene& scene, const Vertex& v, const Vec3& back, SampleSource& source) {
    Rgb sum = next_event(scene, v, back, source);
    const auto next = continue_walk(v, back, From::eye, source);
    if (!next || is_specular(next->event)) return sum;
    const auto hit = next_vertex(scene, v, next->w);
    if (hit && hit->point.is_emitter())
        sum += next->weight * scene.transmittance(v.point, hit->point) *
               emission_with_mis(scene, v, *hit, next->w, next->pdf);
    return sum;
}

} // namespace keyhole
