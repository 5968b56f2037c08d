#include "gather/direct_light.h"

namespace keyhole {

Rgb next_event(const Scene& scene, const Vertex& v, const Vec3& back, SampleSource& source) {
    const auto light = sample_direct_light(scene, v, back, source);
    return light && scene.visible(v.point, light->x0.point) ? light->value : Rgb(0.0);
}

Rgb direct_light(const Scene& scene, const Vertex& v, const Vec3& back, SampleSource& source) {
    Rgb sum(0.0);
    sample_both_techniques(scene, v, back, source,
                           [&](const SurfacePoint& /*emitter*/, const Rgb& value, bool visible) {
                               if (visible) sum += value;
                           });
    return sum;
}

} // namespace keyhole
