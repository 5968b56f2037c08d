#include "gather/gather_rays.h"

#include "gather/direct_irradiance.h"
#include "gather/direct_light.h"
#include "gather/photon_reflection.h"
#include "photonmap/confirmation.h"
#include "photonmap/few_photons.h"
#include "photonmap/surface/density_in_sight.h"
#include "sampling/paths/direct_light.h"
#include "sampling/paths/gather_coverage.h"
#include "sampling/paths/lamps_in_lobes.h"
#include "sampling/paths/random_walk.h"
#include "scene/bsdfs/wide_lobe.h"

namespace keyhole {
namespace {

/// The lookup of light that comes to `v` on the side of `normal`.
PhotonQuery query_at(const Vertex& v, const Vec3& normal, float radius, const LookupOptions& options) {
    return {{v.point.p, normal}, radius, options.nearest, options.shrink};
}

/// The sum of look(normal) for each side from which light that comes to `v` is scattered towards `back`.
template <class Look> auto on_each_side(const Vertex& v, const Vec3& back, const Look& look) {
    const Vec3 near = facing(v.point.ng, back);
    auto sum = look(near);
    if (v.bsdf.traits().through) sum += look(-near);
    return sum;
}

/// Least probability with which the glossy part is looked at where a ray ends.
constexpr double kLeastGlossy = 0.05;

/// Of a place's radius, how far from it what stands around it is known well enough.
constexpr float kKnown = 0.25f;

/// Of a place's radius, how far from it direct light may be that of the place. Places are where photons fell, and so in
/// the light rather than in the shadow beside it: farther away nothing is known of that.
constexpr float kInTheSameLight = 0.5f;

/// Caustics are the lesser part of the light where they are below this share of the rest; least probability with which
/// they are looked at there.
constexpr double kLesserCaustic = 0.1, kLeastLook = 0.1;

/// Of the radius of the region around a photon of the caustic map itself, how far it lights. A lookup in the dark grows
/// until it has taken in enough photons of the next spot, however far that is: by 1 / r^2 a spot of k photons would
/// bring several times its power to all the surface around it. Where photons are spread evenly, all in a lookup light
/// it.
constexpr float kLit = 1.5f;

/// Cosine between shading normal and surface below which irradiance through the surface won't do: what a bumped surface
/// reflects of a low sun is another light.
constexpr float kBent = 0.97f;

bool is_bent(const Vertex& v) { return std::abs(v.bsdf.shading_normal().dot(v.point.ng)) < kBent; }

/// The diffuse part of `v` alone, as it is seen from `back`.
Vertex painted(const Vertex& v, const Vec3& back) {
    Vertex paint = v;
    paint.bsdf = Bsdf(Frame(v.bsdf.shading_normal()), DiffuseBsdf{v.bsdf.diffuse_reflectance(back) * kPi});
    return paint;
}

/// Photons of a caustic that are tested for sight, and photons that a lobe at the end of a gather ray is asked about.
/// The error that a few more would save is one of this sample alone, and small beside its others.
constexpr int kSights = 8, kPhotonsOfLobe = 16;

} // namespace

/// The walk along a gather ray, through specular vertices. It ends where the maps are asked: its last vertex is d2, so
/// that what it finds is what stored_kind() leaves to final gather.
struct GatherRays::Walk : SpecularWalkHooks {
    const GatherRays& rays;
    SampleSource& source;
    const Vertex& from;
    double pdf; // of the first ray
    Leg leg;
    Arrival arrival{};
    StraightLight light{};
    LastTwoVertices vertices{};

    Vertex& place() { return vertices.place(); }
    bool arrive(Vertex& v, const WalkRay& ray) {
        leg.distance = v.point.site == Site::infinite ? std::numeric_limits<float>::infinity()
                                                      : (v.point.p - ray.last->p).length();
        if (v.point.is_emitter()) meet_emitter(v, ray);
        if (ray.last == &from.point) arrival.distance = leg.distance;
        if (leg.scatterings == rays.max_scatterings_) return false;
        if (v.bsdf.traits().finite) {
            End end;
            const Rgb light = rays.reflected(v, -ray.w, leg, source, end);
            rays.add(ray.throughput, light, end, leg, arrival);
        }
        ++leg.scatterings;
        return v.bsdf.traits().delta;
    }
    /// An emitter seen straight is direct light; seen through other specular vertices the caustic map has it, but for
    /// what narrow lobes show of large lamps.
    void meet_emitter(const Vertex& v, const WalkRay& ray) {
        if (light.straight(ray.w, v.point.site == Site::infinite))
            arrival.emitted += ray.throughput * emission_with_mis(rays.scene_, from, v, ray.w, pdf);
        else if (is_large_lamp(rays.scene_, v.point))
            arrival.lamps += ray.throughput * rays.scene_.emitter(v.point.emitter).radiance(v.point, -ray.w);
    }
    bool leave(const Vertex& v, const Continuation& next, const WalkRay& ray) {
        light.meet(v, ray.w);
        return SpecularWalkHooks::leave(v, next, ray);
    }
};

GatherRays::Arrival GatherRays::trace(const Vertex& from, const Vec3& w, double pdf, int scatterings,
                                      SampleSource& source) const {
    return trace(from, w, pdf, {0, scatterings, 0}, source);
}

GatherRays::Arrival GatherRays::trace(const Vertex& from, const Vec3& w, double pdf, const Leg& start,
                                      SampleSource& source) const {
    Walk walk{{}, *this, source, from, pdf, start};
    random_walk(scene_, From::eye, {&from.point, &from.point, w}, max_scatterings_ + 1 - start.scatterings, source,
                walk);
    return walk.arrival;
}

LightSamples GatherRays::at_end(const Leg& leg) const { return {1, faces_left(leg.scatterings + 1)}; }

void GatherRays::add(const Rgb& throughput, const Rgb& light, const End& end, const Leg& leg, Arrival& arrival) const {
    arrival.indirect += throughput * light;
    const double all = luminance(throughput * light), direct = std::min(all, luminance(throughput * end.direct));
    // Of what photons bring, all, where nobody knows more.
    const auto share_by = [&](int longer) {
        return end.place ? maps_.irradiance->share_that_reaches(*end.place, longer) : 1.0;
    };
    const double known = share_by(leg.longer());
    for (int k = 1; k <= kLongerWays; ++k) {
        const double share = share_by(leg.longer() + k);
        arrival.reaching[static_cast<std::size_t>(k - 1)] +=
            static_cast<float>((leg.scatterings + 1 + k <= max_scatterings_ ? direct : 0) +
                               (known > 0 ? (all - direct) * share / known : 0));
    }
}

Rgb GatherRays::reflected(Vertex& v, const Vec3& back, const Leg& leg, SampleSource& source, End& end) const {
    if (!is_covered(maps_.coverage, v, back)) return Rgb(0.0);
    if (maps_.irradiance == nullptr || maps_.irradiance->places().empty()) {
        end.direct = direct_light(scene_, v, back, at_end(leg), source);
        return end.direct + global(v, back, leg.longer());
    }
    const SurfaceRegion here{v.point.p, facing(v.point.ng, back)};
    const auto known = maps_.irradiance->irradiance(v.point, here.normal);
    // Photons may be near, but none that this place sees: those of the other side of a wall.
    const auto place = known.known ? std::optional(known.place) : std::nullopt;
    end.place = place;
    if (!v.bsdf.traits().diffuse) return lobe(v, back, place, leg, source);
    const bool on = goes_on(leg, place, here);
    const double share = place && !on ? maps_.irradiance->share_that_reaches(*place, leg.longer()) : 1;
    Rgb sum(0.0), direct_here(0.0);
    if (is_bent(v)) {
        const Vertex paint = painted(v, back);
        sum = end.direct = direct_light(scene_, paint, back, at_end(leg), source);
        if (place && !on) sum += photons({false, leg.longer()}, *place, paint, here.normal, back, source);
    } else {
        const Rgb f = v.bsdf.diffuse_reflectance(back);
        direct_here = direct(place, v, here, leg, source);
        sum = end.direct = f * direct_here;
        if (place && !on) sum += f * known.irradiance * share;
    }
    if (on) sum += traced_on(v, back, place, direct_here + known.irradiance, leg, source);
    if (!v.bsdf.traits().glossy) return sum;
    // Seldom, and all the more then.
    const double p = std::max(kLeastGlossy, v.bsdf.glossy_probability(back));
    if (!(source.next() < p)) return sum;
    const Widened glossy = widened(v, v.bsdf.glossy_part(), back);
    Rgb shine = direct_light(scene_, glossy.v, back, at_end(leg), source);
    // What is traced on brings the indirect light of all parts.
    if (place && !on) shine += photons({false, leg.longer()}, *place, glossy.v, here.normal, back, source);
    return sum + shine * (glossy.scale / p);
}

Rgb GatherRays::direct(const std::optional<std::uint32_t>& place, const Vertex& v, const SurfaceRegion& here,
                       const Leg& leg, SampleSource& source) const {
    if (place && !is_fine(*place) && maps_.irradiance->is_near(*place, here, kInTheSameLight))
        if (const auto near = maps_.direct->direct(*place, v.point.p)) return *near;
    return direct_irradiance(scene_, v.point, v.bsdf, here.normal, at_end(leg), source).irradiance;
}

GatherRays::Widened GatherRays::widened(const Vertex& v, const Bsdf& part, const Vec3& back) const {
    const WideLobe lobe = wide_lobe(part, options_.least_alpha, back);
    Widened wide{v, lobe.scale};
    wide.v.bsdf = lobe.bsdf;
    return wide;
}

Rgb GatherRays::lobe(const Vertex& v, const Vec3& back, const std::optional<std::uint32_t>& place, const Leg& leg,
                     SampleSource& source) const {
    const bool may_trace = maps_.lobes != nullptr && leg.traced_on == 0;
    if (may_trace && !(place && maps_.lobes->by_photons(v.point.shape)))
        return lobe_traced_on(v, back, place, leg, source);
    const Widened wide = widened(v, v.bsdf, back);
    return wide.scale * (direct_light(scene_, wide.v, back, at_end(leg), source) +
                         photons_on_each_side({false, leg.longer()}, place, wide.v, back, source));
}

Rgb GatherRays::lobe_traced_on(const Vertex& v, const Vec3& back, const std::optional<std::uint32_t>& place,
                               const Leg& leg, SampleSource& source) const {
    Rgb sum = next_event(scene_, v, back, at_end(leg), source);
    if (const auto next = continue_walk(v, back, From::eye, source); next && !is_specular(next->event)) {
        const Arrival arrival = trace(v, next->w, next->pdf, {0, leg.scatterings + 1, leg.traced_on + 1}, source);
        sum += next->weight * (arrival.emitted + arrival.indirect);
    }
    // Light that specular vertices alone brought here is found by no ray.
    const Widened wide = widened(v, v.bsdf, back);
    return sum + wide.scale * photons_on_each_side({true, leg.longer()}, place, wide.v, back, source);
}

std::optional<std::uint32_t> GatherRays::place_at(const Vertex& v, const Vec3& normal) const {
    const auto known = maps_.irradiance->irradiance(v.point, normal);
    return known.known ? std::optional(known.place) : std::nullopt;
}

Rgb GatherRays::photons_on_each_side(Asked asked, const std::optional<std::uint32_t>& near, const Vertex& v,
                                     const Vec3& back, SampleSource& source) const {
    return on_each_side(v, back, [&](const Vec3& normal) {
        const auto place = normal.dot(back) > 0 ? near : place_at(v, normal);
        const bool any = place && (!asked.caustics || maps_.irradiance->has_caustics(*place));
        return any ? photons(asked, *place, v, normal, back, source) : Rgb(0.0);
    });
}

std::optional<LobeNoise> GatherRays::lobe_noise(const Vertex& v, const Vec3& back, int scatterings,
                                                SampleSource& source) const {
    const auto place = place_at(v, facing(v.point.ng, back));
    if (!place) return std::nullopt;
    const auto variance = [](const Rgb& a, const Rgb& b) {
        const double difference = luminance(a) - luminance(b);
        return difference * difference / 2;
    };
    const Leg leg{0, scatterings, 0};
    const Rgb first = lobe_traced_on(v, back, place, leg, source);
    const Rgb second = lobe_traced_on(v, back, place, leg, source);
    const Widened wide = widened(v, v.bsdf, back);
    const Rgb once = direct_light(scene_, wide.v, back, at_end(leg), source),
              again = direct_light(scene_, wide.v, back, at_end(leg), source);
    const double scale = wide.scale * wide.scale;
    return LobeNoise{scale * variance_of_photons(wide.v, back), scale * variance(once, again), variance(first, second)};
}

Rgb GatherRays::caustic(const Vertex& v, const Vec3& back, double besides, int scatterings,
                        SampleSource& source) const {
    if (maps_.caustic == nullptr) return Rgb(0.0);
    return on_each_side(v, back, [&](const Vec3& normal) {
        return caustic_on_side(v, normal, back, besides, scatterings - 1, source) +
               outlying_on_side(v, normal, back, scatterings - 1);
    });
}

Rgb GatherRays::caustic_on_side(const Vertex& v, const Vec3& normal, const Vec3& back, double besides, int longer,
                                SampleSource& source) const {
    const PhotonQuery query = query_at(v, normal, options_.caustic_radius, options_);
    const PilotedRegion piloted = piloted_region(maps_.caustic->pilots(), query);
    const float r = piloted.radius;
    double p = chance_of_caustic(v, back, query.region, r, besides);
    if (!(p > 0)) return Rgb(0.0);
    const PilotSurroundings& surroundings = *maps_.caustic_surroundings;
    // By chance only where a look takes rays.
    if (p < 1 && !maps_.patches->takes_rays() && !surroundings.partly_occluded(query.region, piloted)) p = 1;
    if (p < 1 && !(source.next() < p)) return Rgb(0.0);
    const Surroundings around = surroundings.around(query.region, piloted);
    if (!(around.area > 0)) return Rgb(0.0);
    const PhotonMap& photons = maps_.caustic->main_photons();
    const auto reflected = PhotonReflection::of_caustics(v, back, longer);
    const double area = around.area * p;
    const auto lit = [&](const Photon& photon) {
        const float reach = kLit * surroundings.radius(photon);
        return query.region.distance2(photon.position()) <= reach * reach;
    };
    if (!around.partly_occluded)
        return estimate_density(photons, query.region, r, area,
                                [&](const Photon& photon) { return lit(photon) ? reflected(photon) : Rgb(0.0); })
            .value;
    const auto all = [&](const Photon& photon) {
        return lit(photon) ? luminance(reflected(photon) * photon.power()) : 0.0;
    };
    const auto seen = weight_in_sight(scene_, query.region, r, reflected);
    const auto light = [&](const Photon& photon) { return seen(photon) * photon.power(); };
    return sum_over_few(photons, {query.region, r, kSights}, all, light, source) / area;
}

Rgb GatherRays::outlying_on_side(const Vertex& v, const Vec3& normal, const Vec3& back, int longer) const {
    Rgb sum(0.0);
    if (maps_.outlying == nullptr) return sum;
    const SurfaceRegion region{v.point.p, normal};
    const auto reflected = PhotonReflection::of_caustics(v, back, longer);
    maps_.outlying->for_each_reaching(region, [&](const Photon& photon, const OutlyingPhotons::Lit& lit) {
        const Rgb light = reflected(photon) * photon.power();
        if (!is_black(light) && in_sight(scene_, region, sight_lift(lit.radius), photon.position()))
            sum += light / lit.area;
    });
    return sum;
}

double GatherRays::chance_of_caustic(const Vertex& v, const Vec3& back, const SurfaceRegion& region, float r,
                                     double besides) const {
    const double f = luminance(v.bsdf.eval(facing(v.bsdf.shading_normal(), back), back));
    const double lesser = kLesserCaustic * besides * kPi * static_cast<double>(r) * r;
    double power = 0; // of the photons so far [W]
    const bool enough = maps_.caustic->main_photons().any_within(region, r, [&](const Photon& photon) {
        power += luminance(photon.power());
        return power * f >= lesser;
    });
    if (enough) return 1;
    return power > 0 ? std::max(kLeastLook, power * f / lesser) : 0;
}

double GatherRays::unconfirmed_caustic(const Vertex& v, const Vec3& back) const {
    if (maps_.caustic == nullptr) return 0;
    const PhotonQuery query = query_at(v, facing(v.point.ng, back), options_.caustic_radius, options_);
    const float r = piloted_radius(maps_.caustic->pilots(), query);
    return unconfirmed_share(*maps_.caustic, query.region, r,
                             [reflected = PhotonReflection::of_caustics(v, back, 0)](const Photon& p) {
                                 return luminance(reflected(p) * p.power());
                             });
}

Rgb GatherRays::global(const Vertex& v, const Vec3& back, int longer) const {
    if (maps_.global == nullptr) return Rgb(0.0);
    return on_each_side(v, back, [&](const Vec3& normal) {
        const PhotonQuery query = query_at(v, normal, options_.max_radius, options_);
        const DensityEstimate e =
            estimate_density(*maps_.global, query, maps_.patches, PhotonReflection(v, back, longer));
        return e.value / share_in_reach(maps_.coverage, query.region, e.radius);
    });
}

bool GatherRays::may_be_partly_occluded(std::uint32_t place, const SurfaceRegion& region) const {
    const IrradianceMap& map = *maps_.irradiance;
    return map.obstructed(place) ||
           (!map.is_near(place, region, kKnown) && maps_.patches->obstructed(region, map.radius(place)));
}

double GatherRays::area_near(std::uint32_t place, const SurfaceRegion& region) const {
    const float r = maps_.irradiance->radius(place);
    // A place farther away than that lies on other surfaces, perhaps on the leg of a chair. Rays could tell the area
    // here, but take twice the time of all others; and where no photon came near there is little light.
    const double share = maps_.irradiance->is_near(place, region) ? maps_.irradiance->area_share(place) : 1;
    return share > 0 ? kPi * static_cast<double>(r) * r * share * share_in_reach(maps_.coverage, region, r) : 0;
}

double GatherRays::variance_of_photons(const Vertex& v, const Vec3& back) const {
    if (maps_.global == nullptr) return 0;
    const PhotonReflection reflected(v, back, 0);
    return on_each_side(v, back, [&](const Vec3& normal) {
        double sum2 = 0;
        const auto place = place_at(v, normal);
        const SurfaceRegion region{v.point.p, normal};
        const double area = place ? area_near(*place, region) : 0;
        if (!(area > 0)) return sum2;
        const float r = maps_.irradiance->radius(*place);
        maps_.global->main_photons().for_each_within(region, r, [&](const Photon& p) {
            const double brought = luminance(reflected(p) * p.power()) / area;
            sum2 += brought * brought;
        });
        return sum2;
    });
}

Rgb GatherRays::photons(Asked asked, std::uint32_t place, const Vertex& v, const Vec3& normal, const Vec3& back,
                        SampleSource& source) const {
    if (maps_.global == nullptr) return Rgb(0.0);
    const PhotonQuery query = query_at(v, normal, options_.max_radius, options_);
    const float r = maps_.irradiance->radius(place);
    const double area = area_near(place, query.region);
    if (!(area > 0)) return Rgb(0.0);
    const PhotonMap& map = maps_.global->main_photons();
    const auto few = [&](const auto& weight) {
        const auto power = [&](const Photon& p) { return !asked.caustics || p.caustic() ? luminance(p.power()) : 0.0; };
        const auto light = [&](const Photon& p) { return weight(p) * p.power(); };
        return sum_over_few(map, {query.region, r, kPhotonsOfLobe}, power, light, source) / area;
    };
    const PhotonReflection reflected(v, back, asked.longer);
    if (!may_be_partly_occluded(place, query.region)) return few(reflected);
    return few(weight_in_sight(scene_, query.region, r, reflected));
}

} // namespace keyhole
