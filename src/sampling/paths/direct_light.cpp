#include "sampling/paths/direct_light.h"

#include <algorithm>

namespace keyhole {
namespace {

/// Emitters that have a sample each.
constexpr std::size_t kMostOfEach = 4;
/// An emitter has its sample for sure where its probability is above that of equal chances divided by this.
constexpr double kSurelySampled = 2;

double emitter_probability(const Scene& scene, const SurfacePoint& at, std::uint32_t emitter) {
    const DirectLightSampler* learned = scene.direct_light();
    return learned != nullptr ? learned->probability(at, emitter) : scene.light_tree().probability(at, emitter);
}

/// Of the emitter with that probability.
double expected_samples(const Scene& scene, double probability) {
    return std::min(1.0, kSurelySampled * static_cast<double>(scene.emitters().size()) * probability);
}

/// Over the density of sample_direct_light(), that of sample_light_of().
double density_of_each_over_one(const Scene& scene, double probability) {
    return probability > 0 ? expected_samples(scene, probability) / probability : 0;
}

/// What `v` scatters of the light of an emitter point that was drawn for it.
std::optional<DirectLight> scattered(const Scene& scene, const EmitterPoint& drawn, const Vertex& v, const Vec3& back) {
    const auto& [light, light_pdf] = drawn;
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

} // namespace

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
    const EmitterPoint drawn =
        learned != nullptr ? learned->sample(v.point, source) : sample_by_light_tree(scene, v.point, source);
    return scattered(scene, drawn, v, back);
}

bool has_few_emitters(const Scene& scene) {
    return scene.emitters().size() > 1 && scene.emitters().size() <= kMostOfEach &&
           !scene.emitter_distribution().empty();
}

std::optional<DirectLight> sample_light_of(const Scene& scene, std::uint32_t emitter, const Vertex& v, const Vec3& back,
                                           SampleSource& source) {
    const double probability = emitter_probability(scene, v.point, emitter);
    const double expected = expected_samples(scene, probability), u = source.next();
    if (!(u < expected)) return std::nullopt;
    EmitterPoint drawn;
    if (const DirectLightSampler* learned = scene.direct_light()) {
        drawn = learned->sample_of(v.point, emitter, u / expected, source);
    } else {
        drawn = scene.emitter(emitter).sample_point(source);
        drawn.point.emitter = emitter;
        drawn.pdf *= probability;
    }
    drawn.pdf *= density_of_each_over_one(scene, probability);
    return scattered(scene, drawn, v, back);
}

double direct_light_pdf(const Scene& scene, const Vertex& v, const SurfacePoint& x0) {
    if (!x0.is_emitter() || scene.emitter_distribution().empty()) return 0;
    const DirectLightSampler* learned = scene.direct_light();
    return learned != nullptr ? learned->pdf(v.point, x0) : light_tree_pdf(scene, v.point, x0);
}

Rgb emission_with_mis(const Scene& scene, const Vertex& v, const Vertex& hit, const Vec3& w, double pdf, bool of_each) {
    if (!hit.point.is_emitter()) return Rgb(0.0);
    const Rgb emitted = scene.emitter(hit.point.emitter).radiance(hit.point, -w);
    if (is_black(emitted)) return emitted;
    double by_light = direct_light_pdf(scene, v, hit.point);
    if (of_each) by_light *= density_of_each_over_one(scene, emitter_probability(scene, v.point, hit.point.emitter));
    return emitted * mis_power(solid_angle_to_area(pdf, v.point, hit.point), by_light);
}

} // namespace keyhole
