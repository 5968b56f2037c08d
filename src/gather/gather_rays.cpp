#include "gather/gather_rays.h"

#include "gather/direct_light.h"
#include "photonmap/confirmation.h"
#include "photonmap/sight.h"
#include "sampling/direct_light.h"

namespace keyhole {
namespace {

/// The weight of photons in radiance that the finite part at `v` reflects towards `back`.
auto reflection(const Vertex& v, const Vec3& back) {
    return [&v, back](const Photon& photon) {
        return scatter(v.point, v.bsdf, Event::finite, photon.direction(), back).value;
    };
}

/// The lookup of light that `v` reflects towards `back`.
PhotonQuery query_at(const Vertex& v, const Vec3& back, float radius, const LookupOptions& options) {
    return {{v.point.p, facing(v.point.ng, back)}, radius, options.nearest, options.shrink};
}

} // namespace

GatherRays::Arrival GatherRays::trace(const Vertex& from, const Vec3& w, double pdf, int scatterings,
                                      SampleSource& source) const {
    return trace(from, w, pdf, scatterings, false, source);
}

GatherRays::Arrival GatherRays::trace(const Vertex& from, const Vec3& w0, double pdf, int scatterings, bool secondary,
                                      SampleSource& source) const {
    Arrival arrival;
    Vertex v;
    SurfacePoint last = from.point;
    Vec3 w = w0;
    Rgb throughput(1.0);
    for (int n = scatterings; n <= max_scatterings_; ++n) {
        if (!next_vertex(scene_, last, w, v)) break;
        throughput *= scene_.transmittance(last, v.point);
        const float length =
            v.point.site == Site::infinite ? std::numeric_limits<float>::infinity() : (v.point.p - last.p).length();
        // An emitter seen straight is direct light; seen through specular vertices the caustic map has it.
        if (n == scatterings) {
            if (v.point.is_emitter()) arrival.emitted = throughput * emission_with_mis(scene_, from, v, w, pdf);
            arrival.distance = length;
        }
        if (n == max_scatterings_) break;
        if (v.bsdf.traits().finite) arrival.indirect += throughput * reflected(v, -w, {length, n, secondary}, source);
        if (!v.bsdf.traits().delta) break;
        const auto next = continue_walk(v, -w, From::eye, source);
        if (!next || !is_specular(next->event)) break;
        throughput *= next->weight;
        w = next->w;
        last = v.point;
        v = Vertex();
    }
    return arrival;
}

bool GatherRays::too_near(const Leg& leg, std::uint32_t place) const {
    // The estimate is a mean over its radius. Seen from nearer than that, as in corners, the mean is not good enough.
    // With mirrors or smooth glass it has to be: rays that are traced on would lose the caustics of the place, which
    // only a ray that happens to run into the emitter could find. Light from beyond the reach of rays is lost likewise.
    return !leg.secondary && !scene_.traits().delta && maps_.reach == nullptr &&
           leg.distance < maps_.irradiance->radius(place);
}

Rgb GatherRays::reflected(const Vertex& v, const Vec3& back, const Leg& leg, SampleSource& source) const {
    if (maps_.reach != nullptr && !maps_.reach->comes_to(v.point.p, facing(v.point.ng, back))) return Rgb(0.0);
    if (maps_.irradiance == nullptr || maps_.irradiance->places().empty() || !v.bsdf.traits().near_lambertian) {
        const Rgb direct = direct_light(scene_, v, back, 1, source);
        return direct + global(v, back);
    }
    const auto known = maps_.irradiance->irradiance(v.point, facing(v.point.ng, back));
    // Photons may be near, but none that this place sees: those of the other side of a wall.
    if (!known.known) return direct_light(scene_, v, back, 1, source);
    const Rgb f = v.bsdf.eval(back, back);
    const auto near = maps_.sites->direct(known.place, v.point.p);
    const Rgb direct = near ? f * *near : direct_light(scene_, v, back, 1, source);
    if (!too_near(leg, known.place)) return direct + f * known.irradiance;
    const auto next = continue_walk(v, back, From::eye, source);
    if (!next || is_specular(next->event)) return direct;
    return direct + next->weight * trace(v, next->w, next->pdf, leg.scatterings + 1, true, source).indirect;
}

Rgb GatherRays::caustic(const Vertex& v, const Vec3& back) const {
    if (maps_.caustic == nullptr) return Rgb(0.0);
    const PhotonQuery query = query_at(v, back, options_.caustic_radius, options_);
    const float r = scouted_radius(maps_.caustic->scouts(), query);
    return estimate_density_in_sight(scene_, maps_.caustic->carriers(), query.region, r, *maps_.patches,
                                     reflection(v, back))
        .value;
}

double GatherRays::unconfirmed_caustic(const Vertex& v, const Vec3& back) const {
    if (maps_.caustic == nullptr) return 0;
    const PhotonQuery query = query_at(v, back, options_.caustic_radius, options_);
    const float r = scouted_radius(maps_.caustic->scouts(), query);
    return unconfirmed_share(*maps_.caustic, query.region, r, [reflection = reflection(v, back)](const Photon& p) {
        return luminance(reflection(p) * p.power());
    });
}

Rgb GatherRays::global(const Vertex& v, const Vec3& back) const {
    if (maps_.global == nullptr) return Rgb(0.0);
    const PhotonQuery query = query_at(v, back, options_.max_radius, options_);
    const DensityEstimate e = estimate_density(*maps_.global, query, maps_.patches, reflection(v, back));
    return e.value / share_in_reach(maps_.reach, query.region, e.radius);
}

} // namespace keyhole
