#include "sampling/paths/walk.h"

#include "sampling/paths/measure.h"

#include <algorithm>

namespace keyhole {

namespace {

void look_up_bsdf(Vertex& v) {
    if (v.point.material != nullptr) v.bsdf = v.point.material->bsdf(v.point);
}

} // namespace

Vertex make_vertex(const SurfacePoint& point) {
    Vertex v;
    v.point = point;
    look_up_bsdf(v);
    return v;
}

double sample_emitter(const Scene& scene, SampleSource& source, Vertex& v) {
    const EmitterDistribution& distribution = scene.emitter_distribution();
    if (distribution.empty()) return 0;
    const std::uint32_t i = distribution.sample(source.next());
    const auto [point, pdf] = scene.emitter(i).sample_point(source);
    v.point = point;
    v.point.emitter = i;
    look_up_bsdf(v);
    return distribution.probability(i) * pdf;
}

std::optional<EmitterVertex> sample_emitter(const Scene& scene, SampleSource& source) {
    if (scene.emitter_distribution().empty()) return std::nullopt;
    EmitterVertex x0;
    x0.pdf = sample_emitter(scene, source, x0.vertex);
    return x0;
}

void sample_eye(const Scene& scene, SampleSource& source, Vertex& v) {
    const auto [u0, u1] = source.take<2>();
    v.point = scene.camera().eye(u0, u1);
}

Vertex sample_eye(const Scene& scene, SampleSource& source) {
    Vertex v;
    sample_eye(scene, source, v);
    return v;
}

namespace {

/// Whether the ray has a direction: vertices closer than floats can tell apart leave none between them.
bool has_direction(const Vec3& w) { return w.length2() > 0.5f; }

} // namespace

bool next_vertex(const Scene& scene, const SurfacePoint& from, const Vec3& w, Vertex& v) {
    if (!has_direction(w) || !scene.trace(from, w, v.point)) return false;
    look_up_bsdf(v);
    return true;
}

std::optional<Vertex> next_vertex(const Scene& scene, const SurfacePoint& from, const Vec3& w) {
    std::optional<Vertex> v(std::in_place);
    if (!next_vertex(scene, from, w, *v)) v.reset();
    return v;
}

namespace {

/// The vertex where a medium scatters a ray along `w`. Its normal is for those who show it.
void make_vertex(const Collision& collision, const Vec3& w, Vertex& v) {
    v.point = {};
    v.point.p = collision.p;
    const Vec3 back = (-w).normalized();
    v.point.ng = v.point.ns = back;
    v.point.site = Site::medium;
    v.bsdf = Bsdf(Frame(back), PhaseBsdf{collision.scattering, collision.extinction, collision.anisotropy});
}

} // namespace

Rgb flight_densities(const Rgb& uncollided, const Vertex& to) {
    const auto* phase = to.point.site == Site::medium ? std::get_if<PhaseBsdf>(&to.bsdf.model()) : nullptr;
    return phase != nullptr ? uncollided * Rgb(phase->extinction) : uncollided;
}

double Flight::arrive(const Rgb& densities) {
    relative *= densities;
    const double mean = mean_of_primaries(relative);
    if (mean > 0) relative = relative / Rgb(mean);
    return mean;
}

bool follow(const Scene& scene, WalkRay& ray, Vertex& v, SampleSource& source) {
    if (!scene.has_scattering_media()) {
        if (!next_vertex(scene, *ray.origin, ray.w, v)) return false;
        // From where light sets out: its ray may start nearer than an infinite vertex.
        ray.clear = scene.transmittance(*ray.last, v.point);
        return true;
    }
    if (!has_direction(ray.w)) return false;
    const bool met = scene.trace(*ray.origin, ray.w, v.point);
    if (!ray.flight) ray.flight.emplace(source.next());
    const FreeFlight flown =
        scene.fly(*ray.origin, ray.w, met ? &v.point : nullptr, ray.flight->primary, source.next());
    if (flown.collision)
        make_vertex(*flown.collision, ray.w, v);
    else if (met)
        look_up_bsdf(v);
    else
        return false;
    const bool from_infinity = ray.last->site == Site::infinite;
    const Attenuation attenuation = from_infinity ? scene.attenuation(*ray.last, v.point) : flown.attenuation;
    const double density = ray.flight->arrive(flight_densities(attenuation.uncollided, v));
    if (!(density > 0)) return false;
    ray.clear = attenuation.transmittance / Rgb(density);
    ray.uncollided = attenuation.uncollided;
    return true;
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

std::optional<EmittedLight> emit_along(const Scene& scene, const SurfacePoint& x0, double pdf, const EmitterRay& ray) {
    if (!(pdf > 0) || !(ray.pdf > 0)) return std::nullopt;
    return EmittedLight{x0, ray, scene.emitter(x0.emitter).radiance(x0, ray.w) * (x0.abs_cos(ray.w) / (pdf * ray.pdf))};
}

std::optional<EmittedLight> emit_light(const Scene& scene, const SurfacePoint& x0, double pdf, SampleSource& source) {
    return emit_along(scene, x0, pdf, scene.emitter(x0.emitter).sample_ray(x0, source));
}

std::optional<EmittedLight> emit_light(const Scene& scene, SampleSource& source) {
    const auto start = sample_emitter(scene, source);
    if (!start || !(start->pdf > 0)) return std::nullopt;
    return emit_light(scene, start->vertex.point, start->pdf, source);
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
