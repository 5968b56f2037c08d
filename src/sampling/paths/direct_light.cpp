#include "sampling/paths/direct_light.h"

namespace keyhole {

EmitterPoint sample_by_light_tree(const Scene& scene, const SurfacePoint& at, SampleSource& source) {
    const LightTree::Choice choice = scene.light_tree().sample(at, source.next());
    EmitterPoint light = scene.emitter(choice.emitter).sample_point(source);
    light.point.emitter = choice.emitter;
    light.pdf *= choice.probability;
    return light;
}

double light_tree_pdf(const Scene& scene, const SurfacePoint& at, const SurfacePoint& x0) {
    return scene.light_tree().probability(at, x0.emitter) * scene.emitter(x0.emitter).point_pdf(x0);
}

std::optional<DirectLight> sample_direct_light(const Scene& scene, const Vertex& v, const Vec3& back,
                                               SampleSource& source) {
    if (scene.emitter_distribution().empty()) return std::nullopt;
    const DirectLightSampler* learned = scene.direct_light();
    const auto [light, light_pdf] =
        learned != nullptr ? learned->sample(v.point, source) : sample_by_light_tree(scene, v.point, source);
    if (!(light_pdf > 0)) return std::nullopt;
    const Vec3 to_light = direction(v.point, light);
    const ScatterValue s = scatter(v.point, v.bsdf, Event::finite, to_light, back);
    const Emitter& emitter = scene.emitter(light.emitter);
    const Rgb value = s.value * emitter.radiance(light, -to_light) * (geometry_term(v.point, light) / light_pdf);
    if (is_black(value)) return std::nullopt;
    const double weight =
        emitter.is_delta() ? 1.0 : mis_power(light_pdf, solid_angle_to_area(s.pdf_to_light, v.point, light));
    return DirectLight{make_vertex(light), value * weight};
}

double direct_light_pdf(const Scene& scene, const Vertex& v, const SurfacePoint& x0) {
    if (!x0.is_emitter() || scene.emitter_distribution().empty()) return 0;
    const DirectLightSampler* learned = scene.direct_light();
    return learned != nullptr ? learned->pdf(v.point, x0) : light_tree_pdf(scene, v.point, x0);
}

Rgb emission_with_mis(const Scene& scene, const Vertex& v, const Vertex& hit, const Vec3& w, double pdf) {
    if (!hit.point.is_emitter()) return Rgb(0.0);
    const Rgb emitted = scene.emitter(hit.point.emitter).radiance(hit.point, -w);
    if (is_black(emitted)) return emitted;
    return emitted * mis_power(solid_angle_to_area(pdf, v.point, hit.point), direct_light_pdf(scene, v, hit.point));
}

} // namespace keyhole
