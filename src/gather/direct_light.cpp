#include "gather/direct_light.h"

#include "core/kronecker.h"

#include <array>

namespace keyhole {
namespace {

/// Numbers for samples that share out the unit cube: the first ones of sample j are those of sample 0, j steps of a
/// Kronecker sequence on.
class SharedNumbers final : public SampleSource {
  public:
    explicit SharedNumbers(SampleSource& rest) : rest_(rest) {
        for (double& u : first_) u = rest.next();
    }
    void begin(int sample) {
        sample_ = sample;
        dimension_ = 0;
    }
    double next() override {
        if (dimension_ == first_.size()) return rest_.next();
        const std::size_t d = dimension_++;
        return kronecker(first_[d], sample_, kAlpha[d]);
    }

  private:
    // The choice of a light, and a point on it.
    static constexpr std::array<double, 3> kAlpha{0.4142135623730950, kR2[0], kR2[1]};
    std::array<double, kAlpha.size()> first_{};
    SampleSource& rest_;
    int sample_ = 0;
    std::size_t dimension_ = 0;
};

} // namespace

Rgb next_event(const Scene& scene, const Vertex& v, const Vec3& back, int samples, SampleSource& source) {
    SharedNumbers numbers(source);
    Rgb sum(0.0);
    for (int i = 0; i < samples; ++i) {
        numbers.begin(i);
        const auto light = sample_direct_light(scene, v, back, numbers);
        if (light) sum += light->value * straight_transmittance(scene, v.point, light->x0.point);
    }
    return sum / samples;
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

Rgb direct_light(const Scene& scene, const Vertex& v, const Vec3& back, int samples, SampleSource& source) {
    Rgb sum = next_event(scene, v, back, samples, source);
    sample_emission(scene, v, back, source, [&](const SurfacePoint& /*emitter*/, const Rgb& value) { sum += value; });
    return sum;
}

} // namespace keyhole
