#include "gather/direct_irradiance_cache.h"

#include "core/shared_work.h"
#include "gather/direct_irradiance.h"
#include "photonmap/surface/surface_region.h"
#include "scene/material.h"

#include <algorithm>

namespace keyhole {
namespace {

/// The surface that `place` lies on, found again by a short ray from above. None where something lies in between.
std::optional<SurfacePoint> surface_at(const Scene& scene, const Photon& place) {
    const Vec3 n = place.normal().decode();
    const float above = 1e-4f * scene.bounding_sphere().radius;
    SurfacePoint start;
    start.p = place.position() + n * above;
    start.site = Site::point;
    auto hit = scene.trace(start, -n);
    if (!hit || hit->site != Site::surface || !((hit->p - place.position()).length() < 0.1f * above) ||
        std::abs(hit->ng.dot(n)) < SurfaceRegion::kMinCosine)
        return std::nullopt;
    return hit;
}

} // namespace

DirectIrradianceCache::DirectIrradianceCache(const Scene& scene, std::span<const Photon> places,
                                             const DirectIrradianceOptions& options, const RunContext& context)
    : places_(places), entries_(places.size()) {
    const Range own = own_part(static_cast<std::int64_t>(places.size()), context);
    context.begin("direct irradiance", static_cast<std::uint64_t>(own.size()), "points");
    shared_blocks(entries_, context, [&](std::int64_t /*block*/, std::int64_t i) {
        entries_[static_cast<std::size_t>(i)] = at(scene, static_cast<std::uint32_t>(i), options);
    });
    context.end();
}

DirectIrradianceCache::Entry DirectIrradianceCache::at(const Scene& scene, std::uint32_t i,
                                                       const DirectIrradianceOptions& options) const {
    const Photon& place = places_[i];
    const Vec3 n = place.normal().decode();
    Entry site;
    if (const auto point = surface_at(scene, place)) {
        Rng rng(options.seed, StreamPurpose::irradiance, i);
        const Bsdf bsdf = point->material != nullptr ? point->material->bsdf(*point) : Bsdf();
        const DirectIrradiance light =
            direct_irradiance(scene, *point, bsdf, facing(point->ng, n), options.direct_samples, rng);
        site.direct = SharedExponentRgb(light.irradiance);
        site.reach = light.reach;
    }
    return site;
}

std::optional<Rgb> DirectIrradianceCache::direct(std::uint32_t i, const Vec3& position, float farthest) const {
    const Entry& site = entries_[i];
    const float reach = std::min(site.reach, farthest);
    if ((places_[i].position() - position).length2() > reach * reach) return std::nullopt;
    return site.direct.decode();
}

} // namespace keyhole
