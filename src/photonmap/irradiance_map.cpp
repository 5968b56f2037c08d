#include "photonmap/irradiance_map.h"

#include "core/parallel.h"
#include "photonmap/sight.h"

namespace keyhole {
namespace {

/// Marks estimates with something around them: by a direction that is not the normal.
Photon make_estimate(const Photon& photon, const Vec3& normal, bool obstructed, const Rgb& irradiance) {
    const Frame frame(normal);
    const Vec3 leaning = (normal + frame.s).normalized();
    return {photon.position(), normal, obstructed ? leaning : normal, irradiance};
}

bool is_obstructed(const Photon& estimate) { return estimate.direction().dot(estimate.normal().decode()) < 0.9f; }

struct Estimate {
    Photon value;
    int photons;
};

Estimate estimate_at(const Photon& photon, const PhotonMap& photons, const IrradianceOptions& options) {
    const Vec3 normal = photon.normal().decode();
    // The photon in the middle is there by choice of the place, so it is no evidence of the density there.
    const PhotonQuery query{{photon.position(), normal}, options.max_radius, options.k + 1, options.shrink};
    const auto others = [&](const Photon& p) { return &p == &photon ? 0.0 : 1.0; };
    DensityEstimate e = estimate_density(photons, query, Unbiased::density, options.patches, others);
    const float r = e.radius;
    const bool obstructed = options.scene != nullptr && options.patches->obstructed(query.region, r);
    if (obstructed) {
        const float lift = 2 * r / SurfaceRegion::kFlattening;
        const double seen = share_in_sight(*options.scene, query.region, r, lift);
        // Where nothing is in sight the middle lies in a crevice, and the test says nothing.
        if (seen > 0) {
            e = estimate_density(photons, query, Unbiased::density, options.patches, [&](const Photon& p) {
                return others(p) > 0 && in_sight(*options.scene, query.region, lift, p.position()) ? 1.0 : 0.0;
            });
            e.value /= seen;
        }
    }
    return {make_estimate(photon, normal, obstructed, e.value), e.photons};
}

/// The chosen photons, with irradiance in place of power.
std::vector<Photon> estimate_all(const PhotonMap& photons, const IrradianceOptions& options, const RunContext& context,
                                 double& mean_photons) {
    const auto total = static_cast<std::int64_t>(photons.photons().size());
    const std::int64_t count = (total + options.stride - 1) / options.stride;
    constexpr std::int64_t kBlock = 256;
    const std::int64_t blocks = (count + kBlock - 1) / kBlock;
    std::vector<Photon> estimates(photons.photons().begin(), photons.photons().begin() + count);
    std::vector<std::int64_t> used(static_cast<std::size_t>(blocks), 0);
    context.begin("irradiance", static_cast<std::uint64_t>(count), "estimates");
    parallel_for(blocks, [&](std::int64_t b) {
        for (std::int64_t i = b * kBlock; i < std::min(count, (b + 1) * kBlock); ++i) {
            const Estimate e = estimate_at(photons[static_cast<std::uint32_t>(i * options.stride)], photons, options);
            estimates[static_cast<std::size_t>(i)] = e.value;
            used[static_cast<std::size_t>(b)] += e.photons;
        }
        context.advance(kBlock);
    });
    context.end();
    std::int64_t sum = 0;
    for (const std::int64_t u : used) sum += u;
    mean_photons = count > 0 ? static_cast<double>(sum) / static_cast<double>(count) : 0.0;
    return estimates;
}

} // namespace

IrradianceMap::IrradianceMap(const PhotonMap& photons, const IrradianceOptions& options, const RunContext& context)
    : map_(estimate_all(photons, options, context, mean_photons_)), max_radius_(options.max_radius),
      scene_(options.scene) {}

IrradianceMap::Answer IrradianceMap::irradiance(const Vec3& position, const Vec3& normal) const {
    // Farther than the estimates themselves look: where photons are rare, most places have none that near, and to call
    // them dark would take light away.
    const PhotonQuery query{{position, normal}, 4 * max_radius_, 1};
    const Neighbourhood near = map_.nearest(query);
    if (near.found.empty()) return {};
    const Photon* estimate = &map_[near.found[0].index];
    if (scene_ != nullptr && is_obstructed(*estimate)) {
        const auto visible = [&](const Photon& p) {
            const float lift = 0.25f * (p.position() - position).length();
            return in_sight(*scene_, query.region, lift, p.position());
        };
        if (!visible(*estimate)) estimate = map_.nearest_accepted(query, visible);
        if (estimate == nullptr) return {};
    }
    return {estimate->power(), true, static_cast<std::uint32_t>(estimate - map_.photons().data())};
}

} // namespace keyhole
