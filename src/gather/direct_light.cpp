#include "gather/direct_light.h"

#include "core/kronecker.h"

namespace keyhole {

Rgb next_event(const Scene& scene, const Vertex& v, const Vec3& back, const LightSamples& samples,
               SampleSource& source) {
    SharedNumbers numbers(source);
    Rgb sum(0.0);
    for (int i = 0; i < samples.number; ++i) {
        numbers.begin(static_cast<std::uint32_t>(i));
        const auto light = sample_direct_light(scene, v, back, numbers);
        if (light) sum += light->value * straight_transmittance(scene, v.point, light->x0.point, samples.most_faces);
    }
    return sum / samples.number;
}

std::optional<PartContinuation> continue_by_part(const Vertex& v, const Bsdf& part, const Vec3& back,
                                                 SampleSource& source) {
    const auto s = part.sample(back, source);
    if (!s || is_specular(s->event)) return std::nullopt;
    const ScatterValue whole = scatter(v.point, v.bsdf, Event::finite, s->to, back);
    if (!(whole.pdf_to_light > 0)) return std::nullopt;
    const double cosine = v.point.abs_cos(s->to);
    return PartContinuation{s->to, scatter(v.point, part, Event::finite, s->to, back).value * (cosine / s->pdf),
                            whole.value * (cosine / whole.pdf_to_light), whole.pdf_to_light, s->pdf};
}

Rgb direct_light(const Scene& scene, const Vertex& v, const Vec3& back, const LightSamples& samples,
                 SampleSource& source) {
    Rgb sum = next_event(scene, v, back, samples, source);
    sample_emission(scene, v, back, samples.most_faces, source,
                    [&](const SurfacePoint& /*emitter*/, const Rgb& value) { sum += value; });
    return sum;
}

} // namespace keyhole
