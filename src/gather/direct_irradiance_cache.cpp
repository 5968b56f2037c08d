#include "gather/direct_irradiance_cache.h"

#include "core/shared_work.h"
#include "gather/direct_irradiance.h"
#include "photonmap/surface/surface_region.h"
#include "scene/geometry.h"
#include "scene/material.h"

#include <algorithm>

namespace keyhole {
namespace {

/// Samples of direct light at a place, by either technique: for each emitter, and at most. Many rays of many records
/// meet the same places, so that their noise doesn't average out, and which of many lamps is drawn is most of it.
constexpr std::size_t kSamplesForEmitter = 4, kMostSamples = 16;

/// How far above a place its surface is looked for, and how far from the place it may be found, over what rounding may
/// move it by. Not a share of the scene's size: a board's thickness below a place another surface may lie. What
/// instances add is a bound already, of the place and of the ray, and may come near such a thickness.
constexpr float kAbove = 64, kNear = 8, kInstances = 2;
/// What numbers are rounded by across the normal, and about the origin, where nothing is told by their size.
constexpr float kAcross = 1e-7f, kAtOrigin = 1e-10f;

/// The surface that `place` lies on, found again by a short ray from above. None where something lies in between.
std::optional<SurfacePoint> surface_at(const Scene& scene, const Photon& place) {
    const Vec3 n = place.normal().decode();
    const float rounding = rounding_along(n, place.position()) + kAcross * place.position().length() +
                           kAtOrigin * scene.bounding_sphere().radius,
                of_instances = kInstances * scene.instance_rounding(place.position());
    const float above = kAbove * rounding + of_instances;
    SurfacePoint start;
    start.p = place.position() + n * above;
    start.site = Site::point;
    auto hit = scene.trace(start, -n);
    if (!hit || hit->site != Site::surface ||
        !((hit->p - place.position()).length() < kNear * rounding + of_instances) ||
        std::abs(hit->ng.dot(n)) < SurfaceRegion::kMinCosine)
        return std::nullopt;
    return hit;
}

} // namespace

DirectIrradianceCache::DirectIrradianceCache(const Scene& scene, std::span<const Photon> places, int most_faces,
                                             std::uint64_t seed, const RunContext& context)
    : places_(places), entries_(places.size()) {
    const std::size_t number = std::clamp(kSamplesForEmitter * scene.emitters().size(), std::size_t{1}, kMostSamples);
    const LightSamples samples{static_cast<int>(number), most_faces};
    const Range own = own_part(static_cast<std::int64_t>(places.size()), context);
    const ProgressStage progress(context, "direct irradiance", own.size(), "points");
    shared_blocks(entries_, context, [&](std::int64_t /*block*/, std::int64_t i) {
        entries_[static_cast<std::size_t>(i)] = at(scene, static_cast<std::uint32_t>(i), samples, seed);
    });
}

DirectIrradianceCache::Entry DirectIrradianceCache::at(const Scene& scene, std::uint32_t i, const LightSamples& samples,
                                                       std::uint64_t seed) const {
    const Photon& place = places_[i];
    const Vec3 n = place.normal().decode();
    Entry site;
    if (const auto point = surface_at(scene, place)) {
        Rng rng(seed, StreamPurpose::irradiance, i);
        const Bsdf bsdf = point->material != nullptr ? point->material->bsdf(*point) : Bsdf();
        const DirectIrradiance light = direct_irradiance(scene, *point, bsdf, facing(point->ng, n), samples, rng);
        site.direct = SharedExponentRgb(light.irradiance);
        site.reach = light.reach;
    }
    return site;
}

std::optional<Rgb> DirectIrradianceCache::direct(std::uint32_t i, const Vec3& position) const {
    const Entry& site = entries_[i];
    if ((places_[i].position() - position).length2() > site.reach * site.reach) return std::nullopt;
    return site.direct.decode();
}

} // namespace keyhole
