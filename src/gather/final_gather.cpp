#include "gather/final_gather.h"

#include "sampling/direct_light.h"

namespace keyhole {
namespace {

/// The side of a surface that `w` points to.
Vec3 side(const SurfacePoint& point, const Vec3& w) { return point.ng.dot(w) < 0 ? -point.ng : point.ng; }

/// Hemispherical reflectance where it has a simple form; other finite BSDFs show a typical value.
Rgb albedo(const Vertex& v, const Vec3& back) {
    const Vec3 n = v.bsdf.shading_normal();
    return v.bsdf.eval(n.dot(back) < 0 ? -n : n, back) * kPi;
}

} // namespace

PixelSample FinalGather::sample(const Vec2& image, SampleSource& source) const {
    PixelSample out;
    Vertex v = sample_eye(scene_, source);
    Vec3 w = scene_.camera().ray_direction(v.point, image);
    Rgb throughput(1.0);
    for (int scatterings = 0; scatterings <= options_.max_scatterings; ++scatterings) {
        const auto hit = next_vertex(scene_, v, w);
        if (!hit) break;
        throughput *= scene_.transmittance(v.point, hit->point);
        if (scatterings == 0 && hit->point.site != Site::infinite) {
            const Vec3 d = hit->point.p - v.point.p;
            out.depth = d.length();
        }
        v = *hit;
        if (v.point.is_emitter()) out.direct += throughput * scene_.emitter(v.point.emitter).radiance(v.point, -w);
        if (scatterings == options_.max_scatterings) break;
        if (v.bsdf.traits().finite) {
            out.albedo += throughput * albedo(v, -w);
            if (out.normal.length2() == 0) out.normal = side(v.point, -w);
            shade(v, -w, throughput, scatterings + 1, source, out);
        }
        // The finite part is done; only specular events lead on.
        if (!v.bsdf.traits().delta) break;
        const auto next = continue_walk(v, -w, From::eye, source);
        if (!next || !is_specular(next->event)) break;
        throughput *= next->weight;
        w = next->w;
    }
    return out;
}

void FinalGather::shade(const Vertex& v, const Vec3& back, const Rgb& throughput, int scatterings, SampleSource& source,
                        PixelSample& out) const {
    Rgb direct = direct_light(v, back, source), indirect(0.0);
    for (int i = 0; i < options_.rays; ++i) {
        Rgb hit_light(0.0);
        indirect += gather_ray(v, back, scatterings, source, out, hit_light) / options_.rays;
        direct += hit_light / options_.rays;
    }
    out.direct += throughput * direct;
    out.indirect += throughput * indirect;
    if (maps_.caustic != nullptr) out.caustic += throughput * ask_caustic_map(v, back);
}

Rgb FinalGather::direct_light(const Vertex& v, const Vec3& back, SampleSource& source) const {
    const auto light = sample_direct_light(scene_, v, back, source);
    return light && scene_.visible(v.point, light->x0.point) ? light->value : Rgb(0.0);
}

Rgb FinalGather::direct_light_alone(const Vertex& v, const Vec3& back, SampleSource& source) const {
    Rgb sum = direct_light(v, back, source);
    const auto next = continue_walk(v, back, From::eye, source);
    if (!next || is_specular(next->event)) return sum;
    const auto hit = next_vertex(scene_, v, next->w);
    if (hit && hit->point.is_emitter())
        sum += next->weight * scene_.transmittance(v.point, hit->point) *
               emission_with_mis(scene_, v, *hit, next->w, next->pdf);
    return sum;
}

Rgb FinalGather::gather_ray(const Vertex& from, const Vec3& back, int scatterings, SampleSource& source,
                            PixelSample& out, Rgb& direct) const {
    const auto first = continue_walk(from, back, From::eye, source);
    if (!first || is_specular(first->event)) return Rgb(0.0);
    Vertex v = from;
    Vec3 w = first->w;
    Rgb throughput = first->weight, sum(0.0);
    for (int n = scatterings; n <= options_.max_scatterings; ++n) {
        const auto hit = next_vertex(scene_, v, w);
        if (!hit) break;
        throughput *= scene_.transmittance(v.point, hit->point);
        // An emitter seen straight is direct light; seen through specular vertices the caustic map has it.
        if (n == scatterings) direct = throughput * emission_with_mis(scene_, v, *hit, w, first->pdf);
        v = *hit;
        if (n == options_.max_scatterings) break;
        if (v.bsdf.traits().finite)
            sum += throughput * (ask_global_map(v, -w, out) + direct_light_alone(v, -w, source));
        if (!v.bsdf.traits().delta) break;
        const auto next = continue_walk(v, -w, From::eye, source);
        if (!next || !is_specular(next->event)) break;
        throughput *= next->weight;
        w = next->w;
    }
    return sum;
}

Rgb FinalGather::ask_global_map(const Vertex& v, const Vec3& back, PixelSample& /*out*/) const {
    if (maps_.global == nullptr) return Rgb(0.0);
    const Vec3 normal = side(v.point, back);
    if (maps_.irradiance != nullptr && v.bsdf.traits().near_lambertian) {
        const auto answer = maps_.irradiance->irradiance(v.point.p, normal);
        return v.bsdf.eval(back, back) * answer.irradiance;
    }
    const PhotonQuery query{{v.point.p, normal}, options_.max_radius, options_.nearest, options_.shrink};
    return estimate_density(*maps_.global, query, Unbiased::density, maps_.patches,
                            [&](const Photon& photon) {
                                return scatter(v.point, v.bsdf, Event::finite, photon.direction(), back).value;
                            })
        .value;
}

Rgb FinalGather::ask_caustic_map(const Vertex& v, const Vec3& back) const {
    const PhotonQuery query{
        {v.point.p, side(v.point, back)}, options_.caustic_radius, options_.nearest, options_.shrink};
    return estimate_density(*maps_.caustic, query, Unbiased::density, maps_.patches,
                            [&](const Photon& photon) {
                                return scatter(v.point, v.bsdf, Event::finite, photon.direction(), back).value;
                            })
        .value;
}

} // namespace keyhole
