#include "sampling/direct_light.h"

namespace keyhole {

std::optional<DirectLight> sample_direct_light(const Scene& scene, const Vertex& v, const Vec3& back,
                                               SampleSource& source) {
    const auto x0 = sample_emitter(scene, source);
    if (!x0 || !(x0->pdf > 0)) return std::nullopt;
    const SurfacePoint& light = x0->vertex.point;
    const Vec3 to_light = direction(v.point, light);
    const ScatterValue s = scatter(v.point, v.bsdf, Event::finite, to_light, back);
    const Emitter& emitter = scene.emitter(light.emitter);
    const Rgb value = s.value * emitter.radiance(light, -to_light) * (geometry_term(v.point, light) / x0->pdf);
    if (is_black(value)) return std::nullopt;
    const double weight =
        emitter.is_delta() ? 1.0 : mis_power(x0->pdf, solid_angle_to_area(s.pdf_to_light, v.point, light));
    return DirectLight{x0->vertex, value * weight};
}

Rgb emission_with_mis(const Scene& scene, const Vertex& v, const Vertex& hit, const Vec3& w, double pdf) {
    if (!hit.point.is_emitter()) return Rgb(0.0);
    const Rgb emitted = scene.emitter(hit.point.emitter).radiance(hit.point, -w);
    if (is_black(emitted)) return emitted;
    return emitted * mis_power(solid_angle_to_area(pdf, v.point, hit.point), emitter_point_pdf(scene, hit.point));
}

} // namespace keyhole
