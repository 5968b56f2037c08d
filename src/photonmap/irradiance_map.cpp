#include "photonmap/irradiance_map.h"

#include "core/parallel.h"

namespace keyhole {
namespace {

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
            const Photon& photon = photons[static_cast<std::uint32_t>(i * options.stride)];
            // The photon in the middle is there by choice of the place, so it is no evidence of the density there.
            const PhotonQuery query{{photon.position(), photon.normal().decode()}, options.max_radius, options.k + 1};
            const DensityEstimate e = estimate_density(photons, query, Unbiased::density, options.patches,
                                                       [&](const Photon& p) { return &p == &photon ? 0.0 : 1.0; });
            Photon& out = estimates[static_cast<std::size_t>(i)];
            out = photon;
            out.set_power(e.value);
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
    : map_(estimate_all(photons, options, context, mean_photons_)), max_radius_(options.max_radius) {}

IrradianceMap::Answer IrradianceMap::irradiance(const Vec3& position, const Vec3& normal) const {
    const Neighbourhood near = map_.nearest({{position, normal}, max_radius_, 1});
    if (near.found.empty()) return {};
    return {map_[near.found[0].index].power(), true};
}

} // namespace keyhole
