#include "photonmap/deposit.h"

#include "core/rng.h"
#include "sampling/paths/lamps_in_lobes.h"
#include "sampling/paths/measure.h"
#include "sampling/paths/path.h"
#include "sampling/paths/random_walk.h"
#include "scene/scene.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace keyhole {
namespace {

// Camera sub-paths: ways from d2 to the eye.

/// A vertex that may be d1 or, by its specular part, stand before it: it is taken for either half of the time.
bool ambiguous(const Vertex& v) { return v.bsdf.traits().finite && v.bsdf.traits().delta; }

/// Share of the draws that begin at the eye: where nothing is specular none need to.
double share_from_eye(const Scene& scene) { return scene.traits().delta ? 0.25 : 0.0; }

/// Whether a walk that has come to `v` takes it for a vertex of finite density, or goes on by a specular part.
bool stops_at(const Vertex& v, SampleSource& source) {
    return v.bsdf.traits().finite && !(ambiguous(v) && source.next() < 0.5);
}

bool scatters(const Vertex& v, const Vec3& to_light, const Vec3& to_eye) {
    return !is_black(scatter(v.point, v.bsdf, Event::finite, to_light, to_eye).value);
}

/// A walk through specular vertices to a d1, from which arrived(d1, ray) says whether the camera sub-path is one.
template <class Arrived> struct WalkToD1 : WalkHooks {
    SampleSource& source;
    const Arrived& arrived;
    int left; // vertices that there may be
    LastTwoVertices vertices{};
    bool found = false;

    Vertex& place() { return vertices.place(); }
    bool arrive(Vertex& v, const WalkRay& ray) {
        if (v.point.site != Site::surface) return false;
        if (!stops_at(v, source)) return true;
        found = arrived(v, ray);
        return false;
    }
    bool leave(const Vertex& v, const Continuation& /*next*/, const WalkRay& /*ray*/) {
        return v.specular() && --left > 0;
    }
};

template <class Arrived>
bool walk_to_d1(const Scene& scene, From from, const WalkRay& ray, int max_scatterings, SampleSource& source,
                const Arrived& arrived) {
    WalkToD1<Arrived> walk{{}, source, arrived, max_scatterings};
    // From the eye even the last vertex is asked how light goes on, though nothing follows from that.
    random_walk(scene, from, ray, max_scatterings + (from == From::eye ? 1 : 0), source, walk);
    return walk.found;
}

/// Scattering at d2 and specular vertices as far as d1, then a straight edge to the eye.
bool draw_from_light(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
                     SampleSource& source) {
    const auto next = continue_walk(d2, to_light, From::light, source);
    if (!next || is_specular(next->event)) return false;
    const WalkRay start{&d2.point, &d2.point, next->w};
    return walk_to_d1(scene, From::light, start, max_scatterings, source, [&](const Vertex& d1, const WalkRay& ray) {
        const Vertex eye = sample_eye(scene, source);
        const Vec3 to_eye = direction(d1.point, eye.point);
        return scene.camera().image_point(eye.point, -to_eye) && scatters(d1, -ray.w, to_eye) &&
               scene.visible(d1.point, eye.point);
    });
}

/// From anywhere in the image through at least one specular vertex to d1, then a straight edge to d2.
bool draw_from_eye(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
                   SampleSource& source) {
    const Vertex eye = sample_eye(scene, source);
    const double u0 = source.next(), u1 = source.next();
    const WalkRay start = eye_ray(scene, eye.point, {static_cast<float>(u0), static_cast<float>(u1)});
    return walk_to_d1(scene, From::eye, start, max_scatterings, source, [&](const Vertex& d1, const WalkRay& ray) {
        const Vec3 to_d2 = direction(d1.point, d2.point);
        return ray.last != &eye.point && scatters(d1, to_d2, -ray.w) && scatters(d2, to_light, -to_d2) &&
               scene.visible(d1.point, d2.point);
    });
}

/// Density with which sample_camera_subpath() draws the camera sub-path of a measured path from vertex d2 on, in the
/// coordinates of the path. 0 where it never does: where specular vertices stand on both sides of d1.
double camera_subpath_density(const Scene& scene, const Path& path, int d2) {
    const int d1 = nth_finite_from_eye(path, 1), eye = path.vertices() - 1;
    const bool straight_to_eye = d1 == eye - 1, straight_to_d2 = d1 == d2 + 1;
    if (d1 <= d2 || !(straight_to_eye || straight_to_d2)) return 0;
    // The lens has a density of its own; the image point is as uniform as the window.
    double density = path.x[eye].pdf_from_eye;
    density *= straight_to_eye ? 1 - share_from_eye(scene) : share_from_eye(scene);
    const int first = straight_to_eye ? d2 + 1 : d1, last = straight_to_eye ? d1 : eye - 1;
    for (int i = first; i <= last; ++i) {
        const Vertex& v = path.x[i];
        density *= (straight_to_eye ? v.pdf_from_light : v.pdf_from_eye) * (ambiguous(v) ? 0.5 : 1.0);
    }
    return density;
}

/// Draws a camera sub-path for `d2`, which light reaches from `to_light`: by scattering there and a straight edge from
/// d1 to the eye, or, where the scene has specular surfaces, from the eye through some of them to d1 and a straight
/// edge to d2. Whether that is a path that carries light, with at most `max_scatterings` vertices between d2 and the
/// eye.
bool sample_camera_subpath(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
                           SampleSource& source) {
    const double from_eye = share_from_eye(scene);
    return from_eye > 0 && source.next() < from_eye ? draw_from_eye(scene, d2, to_light, max_scatterings, source)
                                                    : draw_from_light(scene, d2, to_light, max_scatterings, source);
}

/// The number of draws until one carries light: its expectation is the reciprocal of the probability of that (Booth
/// 2007; Zeltner et al. 2020). None after `most` draws.
std::optional<std::int64_t> draws_until_valid(const Scene& scene, const Vertex& d2, const Vec3& to_light,
                                              int max_scatterings, std::int64_t most, SampleSource& source) {
    for (std::int64_t n = 1; n <= most; ++n)
        if (sample_camera_subpath(scene, d2, to_light, max_scatterings, source)) return n;
    return std::nullopt;
}

/// Whether specular vertices, and no others, lie between the light and vertex i.
bool specular_before(const Path& path, std::size_t i) {
    return i > 1 && std::all_of(path.x.begin() + 1, path.x.begin() + static_cast<std::ptrdiff_t>(i),
                                [](const Vertex& v) { return v.specular(); });
}

} // namespace

void PathDepositor::Tally::merge(const Tally& o) {
    total += o.total;
    lost += o.lost;
    visible += o.visible;
    visible_weight += o.visible_weight;
    power.merge(o.power);
    literal_power.merge(o.literal_power);
    draws += o.draws;
    untrusted += o.untrusted;
}

bool PathDepositor::Pending::holds(const Path& path, const StoragePoint& at, const Rgb& its_flux) const {
    const int i = at.vertex;
    // Another emitter may send another colour along the same last edge.
    return kind == at.kind && scatterings == i && vertex.point.p == path.x[i].point.p &&
           to_light == direction(path.x[i].point, path.x[i - 1].point) && flux == its_flux;
}

void PathDepositor::Pending::watch(const Path& path) {
    trail.clear();
    for (const Vertex& v : path.x) trail.push_back({v.point.p, v.specular(), v.point.site == Site::infinite});
    emitter = path.x[0].point.emitter;
}

void PathDepositor::deposit(const Path& path, double weight) {
    const StoragePoint at = path.storage;
    if (at.kind == PhotonKind::none || !(weight > 0)) return;
    const int i = at.vertex;
    Rgb flux(1.0);
    for (int k = 0; k < i; ++k) flux *= path.x[k].value / luminance(path.x[k].value);
    if (!recent_.holds(path, at, flux)) {
        std::swap(recent_, older_);
        if (!recent_.holds(path, at, flux)) {
            store(recent_);
            recent_ = {.kind = at.kind,
                       .vertex = path.x[i],
                       .to_light = direction(path.x[i].point, path.x[i - 1].point),
                       .flux = flux,
                       .scatterings = at.vertex,
                       .caustic = specular_before(path, i) &&
                                  (at.kind == PhotonKind::global || is_large_lamp(*options_.scene, path.x[0].point))};
            if (options_.weights != nullptr)
                recent_.share =
                    options_.weights->of_chains(options_.weights->visible(*options_.scene, at.kind, path, at.vertex));
            if (options_.observer != nullptr) recent_.watch(path);
        }
    }
    recent_.weight += weight;
    if (at.kind == PhotonKind::caustic) return;
    // The path was drawn in proportion to its contribution times its pixel's weight.
    const double literal = weight * literal_factor(path, at.vertex, recent_.flux) / options_.set.weight_at(path.image);
    recent_.literal += literal;
    recent_.density += literal * camera_subpath_density(*options_.scene, path, at.vertex);
}

void PathDepositor::flush() {
    store(older_);
    store(recent_);
}

void PathDepositor::store(Pending& pending) {
    const PhotonKind kind = std::exchange(pending.kind, PhotonKind::none);
    const double given = std::exchange(pending.weight, 0);
    if (!(given > 0)) return;
    const double counted = given * pending.share;
    tally_.total += counted;
    store_by_roulette(*buffers_, kind, counted, thresholds_, rng_, [&](double weight) -> std::optional<Photon> {
        const Rgb power = options_.role == PhotonRole::pilot
                              ? Rgb(1.0)
                              : power_of(pending, kind == PhotonKind::global, given, weight);
        if (is_black(power)) return std::nullopt;
        const Photon photon(pending.vertex.point.p, pending.vertex.point.ng, pending.to_light, power / unit_,
                            {.caustic = pending.caustic,
                             .spare = spare_scatterings(kind, pending.scatterings, options_.max_scatterings)});
        if (options_.observer != nullptr)
            options_.observer->stored(
                photon, {pending.trail, static_cast<std::size_t>(pending.scatterings), pending.emitter, false});
        return photon;
    });
}

Rgb PathDepositor::power_of(const Pending& pending, bool global, double given, double weight) {
    const Rgb power = global ? global_power(pending, given, weight) : caustic_power(pending);
    if (is_black(power)) {
        tally_.lost += weight;
    } else if (global) {
        tally_.power.add(luminance(power));
        tally_.literal_power.add(luminance(pending.flux) * (pending.literal / given));
    }
    return power;
}

Rgb PathDepositor::caustic_power(const Pending& pending) const {
    if (!options_.scene->camera().has_lens()) {
        Rgb e = straight_importance(pending);
        if (options_.scene->traits().delta) e += importance(pending, *options_.caustic, Ways::specular).value;
        const Rgb power = marginal_power(pending.flux, e);
        if (!is_black(power)) return power;
    }
    return marginal_power(pending.flux, importance(pending, *options_.caustic).value);
}

Rgb PathDepositor::straight_importance(const Pending& pending) const {
    const Scene& scene = *options_.scene;
    const Vertex& d1 = pending.vertex;
    const SurfacePoint eye = scene.camera().eye(0.5, 0.5);
    const Vec3 to_eye = direction(d1.point, eye);
    const auto image = scene.camera().image_point(eye, -to_eye);
    if (!image || !scene.visible(d1.point, eye)) return Rgb(0.0);
    const double density = solid_angle_to_area(scene.camera().direction_pdf(-to_eye), eye, d1.point);
    const Rgb value =
        scatter(d1.point, d1.bsdf, Event::finite, pending.to_light, to_eye).value * scene.transmittance(d1.point, eye);
    return value * (density * options_.set.weight_at(*image));
}

Rgb PathDepositor::global_power(const Pending& pending, double given, double weight) {
    if (options_.rule == PowerRule::literal) return to_the_letter(pending, given, weight);
    if (options_.rule == PowerRule::marginal) {
        // The choice follows from the place alone, so each rule is as right as it is by itself.
        const auto e = importance(pending, *options_.global);
        if (e.trusted(pending.vertex.bsdf)) return marginal_power(pending.flux, e.value);
        ++tally_.untrusted;
    }
    return by_drawing(pending, given);
}

Rgb PathDepositor::by_drawing(const Pending& pending, double given) {
    if (!(pending.density > 0)) return Rgb(0.0);
    // Without a bound a place that no camera sub-path leaves would hold up the render for ever; what it costs is
    // counted.
    constexpr std::int64_t most = 100'000;
    const auto draws = draws_until_valid(*options_.scene, pending.vertex, pending.to_light,
                                         options_.max_scatterings - pending.scatterings, most, rng_);
    tally_.draws += static_cast<std::uint64_t>(draws.value_or(most));
    return draws ? reciprocal_power(pending.flux, pending.density / given, *draws) : Rgb(0.0);
}

Rgb PathDepositor::to_the_letter(const Pending& pending, double given, double weight) {
    const Rgb power = literal_power(pending.flux, pending.literal / given);
    tally_.visible += weight * luminance(power * importance(pending, *options_.global).value);
    tally_.visible_weight += weight;
    return power;
}

} // namespace keyhole
