#include "sampling/walk.h"

#include "sampling/measure.h"

#include <algorithm>

namespace keyhole {

namespace {

void put_at(const SurfacePoint& point, Vertex& v) {
    v.point = point;
    if (point.material != nullptr) v.bsdf = point.material->bsdf(point);
}

} // namespace

Vertex make_vertex(const SurfacePoint& point) {
    Vertex v;
    put_at(point, v);
    return v;
}

std::optional<EmitterVertex> sample_emitter(const Scene& scene, SampleSource& source) {
    const EmitterDistribution& distribution = scene.emitter_distribution();
    if (distribution.empty()) return std::nullopt;
    const std::uint32_t i = distribution.sample(source.next());
    auto [point, pdf] = scene.emitter(i).sample_point(source);
    point.emitter = i;
    return EmitterVertex{make_vertex(point), distribution.probability(i) * pdf};
}

Vertex sample_eye(const Scene& scene, SampleSource& source) {
    Vertex v;
    const double u0 = source.next(), u1 = source.next();
    v.point = scene.camera().eye(u0, u1);
    return v;
}

bool next_vertex(const Scene& scene, const SurfacePoint& from, const Vec3& w, Vertex& v) {
    // Vertices closer than floats can tell apart leave no direction between them.
    if (!(w.length2() > 0.5f)) return false;
    const auto point = scene.trace(from, w);
    if (point) put_at(*point, v);
    return point.has_value();
}

std::optional<Vertex> next_vertex(const Scene& scene, const SurfacePoint& from, const Vec3& w) {
    std::optional<Vertex> v(std::in_place);
    if (!next_vertex(scene, from, w, *v)) v.reset();
    return v;
}

std::optional<Continuation> continue_walk(const Vertex& v, const Vec3& back, From from, SampleSource& source) {
    const auto s = v.bsdf.sample(back, source);
    if (!s || !(s->pdf > 0)) return std::nullopt;
    const bool eye = from == From::eye;
    const ScatterValue value = scatter(v.point, v.bsdf, s->event, eye ? s->to : back, eye ? back : s->to);
    const double pdf = eye ? value.pdf_to_light : value.pdf_to_eye;
    if (!(pdf > 0)) return std::nullopt;
    return Continuation{s->to,  s->event, value.value * (v.point.abs_cos(s->to) / pdf),
                        s->pdf, pdf,      eye ? value.pdf_to_eye : value.pdf_to_light};
}

double finite_probability(const Vertex& v, const Vec3& back) {
    const BsdfTraits traits = v.bsdf.traits();
    if (!traits.finite) return 0;
    if (!traits.delta) return 1;
    double p = 1;
    for (const Event e : {Event::reflect, Event::transmit})
        if (const auto d = v.bsdf.delta(back, e)) p -= d->probability;
    return std::max(0.0, p);
}

} // namespace keyhole
