#include "gather/final_gather.h"

#include "gather/direct_light.h"
#include "gather/visible_point.h"
#include "sampling/paths/lamps_in_lobes.h"
#include "sampling/paths/random_walk.h"
#include "sampling/paths/seen_surface.h"
#include "sampling/paths/walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace keyhole {
namespace {

/// Glass at which both ways are followed, and coats whose mirror images are: later ones choose. Which way a highlight
/// lies would else be the noisiest question of the picture.
constexpr int kSplits = 1;

} // namespace

PixelSample FinalGather::sample(const Vec2& image, SampleSource& source) const {
    Sample out;
    draw(image, source, out);
    return out;
}

FinalGather::Doubts FinalGather::doubt(const Vec2& image, bool confirm, SampleSource& source) const {
    Sample out;
    out.confirm = confirm;
    draw(image, source, out);
    return {luminance(out.direct + out.indirect + out.caustic), out.unconfirmed, out.of_records, out.rays};
}

struct FinalGather::EyeWalk : SpecularWalkHooks {
    const FinalGather& gather;
    SampleSource& source;
    Sample& out;
    double share = 1;         // probability with which a walk that is not split would have come here
    bool saw_surface = false; // that is not specular
    int splits = kSplits;     // that are left
    int scatterings = 0;      // before the last vertex
    LastTwoVertices vertices{};

    Vertex& place() { return vertices.place(); }

    bool arrive(const Vertex& v, const WalkRay& ray) {
        const Vec3 back = -ray.w;
        if (scatterings == 0 && v.point.site != Site::infinite) out.depth = seen_depth(*ray.last, v.point);
        if (v.point.is_emitter())
            out.direct += ray.throughput * gather.scene_.emitter(v.point.emitter).radiance(v.point, back);
        if (scatterings == gather.rays_.max_scatterings()) return false;
        ++scatterings;
        if (v.bsdf.traits().finite) {
            if (!std::exchange(saw_surface, true)) note_seen_surface(out, v, back, ray.throughput, share);
            gather.shade(v, back, ray.throughput, scatterings, source, out);
        }
        // The finite part is done; only specular events lead on.
        return v.bsdf.traits().delta && !split(v, back, ray.throughput);
    }

  private:
    /// Where splits are left, follows all specular ways on from a vertex that would choose: between two of them, or
    /// between one and the finite part, which is done.
    bool split(const Vertex& v, const Vec3& back, const Rgb& throughput) {
        const std::array lobes{v.bsdf.delta(back, Event::reflect), v.bsdf.delta(back, Event::transmit)};
        const int ways = (lobes[0] ? 1 : 0) + (lobes[1] ? 1 : 0) + (v.bsdf.traits().finite ? 1 : 0);
        if (splits == 0 || ways < 2) return false;
        for (const auto& lobe : lobes) {
            if (!lobe) continue;
            const Rgb weight = lobe->coefficient / (lobe->eta * lobe->eta);
            EyeWalk part{{}, gather, source, out, share * lobe->probability, saw_surface, splits - 1, scatterings};
            part.follow({&v.point, &v.point, lobe->to, throughput * weight});
        }
        return true;
    }

  public:
    void follow(const WalkRay& ray) {
        random_walk(gather.scene_, From::eye, ray, gather.rays_.max_scatterings() + 1 - scatterings, source, *this);
    }
};

void FinalGather::draw(const Vec2& image, SampleSource& source, Sample& out) const {
    const Vertex eye = sample_eye(scene_, source);
    EyeWalk walk{{}, *this, source, out};
    walk.follow(eye_ray(scene_, eye.point, image));
}

void FinalGather::shade(const Vertex& v, const Vec3& back, const Rgb& throughput, int scatterings, SampleSource& source,
                        Sample& out) const {
    const auto cached = ask_cache(v, back, scatterings);
    Light light{Rgb(0.0), cached ? cached->radiance : Rgb(0.0)};
    if (!cached)
        light = gather_all(v, back, scatterings, source);
    else if (v.bsdf.traits().glossy)
        light += gather_glossy(v, back, cached->radiance, scatterings, source);
    else
        light.direct = direct_light(scene_, v, back, light_samples(scatterings), source);
    out.direct += throughput * light.direct;
    out.indirect += throughput * light.indirect;
    out.rays += light.rays;
    const double besides = luminance(light.direct + light.indirect + light.lamps);
    const Rgb caustic = throughput * rays_.caustic(v, back, besides, scatterings, source);
    out.caustic += caustic + throughput * light.lamps;
    if (cached) out.of_records += luminance(throughput) * cached->error;
    if (out.confirm) out.unconfirmed += luminance(caustic) * rays_.unconfirmed_caustic(v, back);
}

std::optional<FinalGather::Cached> FinalGather::ask_cache(const Vertex& v, const Vec3& back, int scatterings) const {
    if (cache_ == nullptr || !v.bsdf.traits().diffuse) return std::nullopt;
    const Vec3 normal = cache_normal(v, back);
    const auto answer = cache_->irradiance(v.point.p, normal, scatterings - 1);
    asked_.fetch_add(1, std::memory_order_relaxed);
    if (!answer.known) {
        unanswered_.fetch_add(1, std::memory_order_relaxed);
        return std::nullopt;
    }
    // Light of the side that is seen geometrically; a shading normal may turn that away.
    if (!(normal.dot(back) > 0)) return Cached{};
    const Rgb f = v.bsdf.diffuse_reflectance(back);
    return Cached{f * answer.irradiance, luminance(f) * answer.error};
}

FinalGather::Light FinalGather::gather_all(const Vertex& v, const Vec3& back, int scatterings,
                                           SampleSource& source) const {
    Light sum{next_event(scene_, v, back, light_samples(scatterings), source), Rgb(0.0)};
    const Bsdf lobe = v.bsdf.glossy_part();
    const bool narrow = is_narrow(lobe, back);
    const int rays = std::max(1, static_cast<int>(std::lround(samples_.rays)));
    const AimedRay aimed(spots_, v, v.bsdf, back, luminance(sum.direct), rays);
    sum.rays = rays;
    for (int i = 0; i < rays; ++i) {
        const auto first = continue_walk(v, back, From::eye, source);
        if (!first || is_specular(first->event)) continue;
        const auto arrival = rays_.trace(v, first->w, first->pdf, scatterings, source);
        sum.indirect += first->weight * arrival.indirect * (first->pdf / aimed.density(first->w, first->pdf));
        sum.direct += first->weight * arrival.emitted / rays;
        if (!narrow || is_black(arrival.lamps)) continue;
        const Rgb part = scatter(v.point, lobe, Event::finite, first->w, back).value;
        sum.lamps += part * arrival.lamps * (v.point.abs_cos(first->w) / (first->pdf * rays));
    }
    sum.indirect += gather_aimed(aimed, v, v.bsdf, back, scatterings, source);
    return sum;
}

FinalGather::Light FinalGather::gather_glossy(const Vertex& v, const Vec3& back, const Rgb& besides, int scatterings,
                                              SampleSource& source) const {
    Light sum{next_event(scene_, v, back, light_samples(scatterings), source), Rgb(0.0)};
    const double glossy = v.bsdf.glossy_probability(back);
    // The BSDF draws from these two parts with this probability, and the two techniques of MIS are weighed by that.
    const double finite = finite_probability(v, back);
    sample_emission_by_diffuse_part(
        scene_, v, back, rays_.faces_left(scatterings), source,
        [&](const SurfacePoint& /*emitter*/, const Rgb& value) { sum.direct += value * (finite * (1 - glossy)); });
    const Bsdf lobe = v.bsdf.glossy_part();
    const bool narrow = is_narrow(lobe, back);
    // A coat of a few percent is worth a ray now and then; not in proportion, for what few rays find each has counts
    // for much: dots.
    const double rays = samples_.rays * std::sqrt(glossy);
    const int drawn = static_cast<int>(rays + source.take<1>()[0]);
    const AimedRay aimed(spots_, v, lobe, back, luminance(sum.direct + besides), rays);
    sum.rays = drawn;
    for (int i = 0; i < drawn; ++i) {
        const auto first = continue_by_part(v, lobe, back, source);
        if (!first) continue;
        const auto arrival = rays_.trace(v, first->w, first->pdf, scatterings, source);
        sum.indirect += first->part * arrival.indirect * (first->part_pdf / aimed.density(first->w, first->part_pdf));
        sum.direct += first->whole * arrival.emitted * (finite * glossy / rays);
        if (narrow) sum.lamps += first->part * arrival.lamps / rays;
    }
    sum.indirect += gather_aimed(aimed, v, lobe, back, scatterings, source);
    return sum;
}

Rgb FinalGather::gather_aimed(const AimedRay& aimed, const Vertex& v, const Bsdf& lobe, const Vec3& back,
                              int scatterings, SampleSource& source) const {
    const auto w = aimed.sample(source);
    if (!w) return Rgb(0.0);
    const ScatterValue s = scatter(v.point, lobe, Event::finite, *w, back);
    const double density = aimed.density(*w, s.pdf_to_light);
    if (!(density > 0) || !(luminance(s.value) > 0)) return Rgb(0.0);
    return s.value * rays_.trace(v, *w, density, scatterings, source).indirect * (v.point.abs_cos(*w) / density);
}

} // namespace keyhole
