#include "gather/final_gather.h"

#include "gather/direct_light.h"
#include "gather/visible_point.h"
#include "sampling/seen_surface.h"

#include <utility>

namespace keyhole {
namespace {

/// Glass at which both ways are followed; later ones choose one. Which way a highlight lies would else be the noisiest
/// question of the picture.
constexpr int kSplits = 1;

} // namespace

PixelSample FinalGather::sample(const Vec2& image, SampleSource& source) const {
    Sample out;
    draw(image, source, out);
    return out;
}

FinalGather::Confirmation FinalGather::confirm(const Vec2& image, SampleSource& source) const {
    Sample out;
    out.confirm = true;
    draw(image, source, out);
    return {luminance(out.direct + out.indirect + out.caustic), out.unconfirmed};
}

void FinalGather::draw(const Vec2& image, SampleSource& source, Sample& out) const {
    const Vertex eye = sample_eye(scene_, source);
    follow({eye, scene_.camera().ray_direction(eye.point, image), Rgb(1.0), 1}, 0, kSplits, source, out);
}

void FinalGather::follow(EyeRay ray, int scatterings, int splits, SampleSource& source, Sample& out) const {
    for (; scatterings <= rays_.max_scatterings(); ++scatterings) {
        const auto hit = next_vertex(scene_, ray.from, ray.w);
        if (!hit) return;
        const Vec3 back = -ray.w;
        ray.throughput *= scene_.transmittance(ray.from.point, hit->point);
        if (scatterings == 0 && hit->point.site != Site::infinite)
            out.depth = (hit->point.p - ray.from.point.p).length();
        const Vertex& v = ray.from = *hit;
        if (v.point.is_emitter())
            out.direct += ray.throughput * scene_.emitter(v.point.emitter).radiance(v.point, back);
        if (scatterings == rays_.max_scatterings()) return;
        if (v.bsdf.traits().finite) {
            if (!std::exchange(ray.saw_surface, true)) note_seen_surface(out, v, back, ray.throughput, ray.share);
            shade(v, back, ray.throughput, scatterings + 1, source, out);
        }
        // The finite part is done; only specular events lead on.
        if (!v.bsdf.traits().delta) return;
        const auto reflected = v.bsdf.delta(back, Event::reflect), transmitted = v.bsdf.delta(back, Event::transmit);
        if (splits > 0 && reflected && transmitted) {
            for (const DeltaScatter& lobe : {*reflected, *transmitted}) {
                const Rgb weight = lobe.coefficient / (lobe.eta * lobe.eta);
                follow({v, lobe.to, ray.throughput * weight, ray.share * lobe.probability, ray.saw_surface},
                       scatterings + 1, splits - 1, source, out);
            }
            return;
        }
        const auto next = continue_walk(v, back, From::eye, source);
        if (!next || !is_specular(next->event)) return;
        ray.throughput *= next->weight;
        ray.w = next->w;
    }
}

void FinalGather::shade(const Vertex& v, const Vec3& back, const Rgb& throughput, int scatterings, SampleSource& source,
                        Sample& out) const {
    if (const auto cached = ask_cache(v, back)) {
        out.direct += throughput * direct_light(scene_, v, back, samples_.light, source);
        out.indirect += throughput * *cached;
    } else {
        Rgb direct = next_event(scene_, v, back, samples_.light, source), indirect(0.0);
        for (int i = 0; i < samples_.rays; ++i) {
            Rgb emitted(0.0);
            indirect += gather(v, back, scatterings, source, emitted) / samples_.rays;
            direct += emitted / samples_.rays;
        }
        out.direct += throughput * direct;
        out.indirect += throughput * indirect;
    }
    const Rgb caustic = throughput * rays_.caustic(v, back);
    out.caustic += caustic;
    if (out.confirm) out.unconfirmed += luminance(caustic) * rays_.unconfirmed_caustic(v, back);
}

std::optional<Rgb> FinalGather::ask_cache(const Vertex& v, const Vec3& back) const {
    if (cache_ == nullptr || !v.bsdf.traits().near_lambertian) return std::nullopt;
    const Vec3 normal = cache_normal(v, back);
    const auto answer = cache_->irradiance(v.point.p, normal);
    asked_.fetch_add(1, std::memory_order_relaxed);
    if (!answer.known) {
        unanswered_.fetch_add(1, std::memory_order_relaxed);
        return std::nullopt;
    }
    return v.bsdf.eval(normal, back) * answer.irradiance;
}

Rgb FinalGather::gather(const Vertex& from, const Vec3& back, int scatterings, SampleSource& source,
                        Rgb& direct) const {
    const auto first = continue_walk(from, back, From::eye, source);
    if (!first || is_specular(first->event)) return Rgb(0.0);
    const auto arrival = rays_.trace(from, first->w, first->pdf, scatterings, source);
    direct = first->weight * arrival.emitted;
    return first->weight * arrival.indirect;
}

} // namespace keyhole
