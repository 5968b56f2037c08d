#include "photonmap/deposit.h"

#include "photonmap/power/camera_subpath.h"
#include "sampling/paths/measure.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace keyhole {
namespace {

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
                       .caustic = specular_before(path, i)};
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
