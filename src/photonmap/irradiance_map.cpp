#include "photonmap/irradiance_map.h"

#include "core/shared_work.h"
#include "photonmap/sight.h"

#include <algorithm>

namespace keyhole {

IrradianceMap::IrradianceMap(const PhotonMap& scouts, const PhotonMap& carriers, const IrradianceOptions& options,
                             const RunContext& context)
    : scouts_(scouts), estimates_(scouts.photons().size()), max_radius_(options.max_radius), scene_(options.scene) {
    constexpr std::int64_t kBlock = 256;
    const Range own = own_part(static_cast<std::int64_t>(estimates_.size()), context);
    std::vector<Count> used(static_cast<std::size_t>((own.size() + kBlock - 1) / kBlock));
    context.begin("irradiance", static_cast<std::uint64_t>(own.size()), "estimates");
    parallel_for(static_cast<std::int64_t>(used.size()), [&](std::int64_t b) {
        for (std::int64_t i = own.begin + b * kBlock; i < std::min(own.end, own.begin + (b + 1) * kBlock); ++i)
            used[static_cast<std::size_t>(b)] += estimate(static_cast<std::uint32_t>(i), carriers, options);
        context.advance(kBlock);
    });
    exchange_parts(estimates_, context);
    context.end();
    if (own.size() == 0) return;
    for (const Count& u : used) mean_ += u;
    mean_.photons /= static_cast<double>(own.size());
    mean_.effective /= static_cast<double>(own.size());
}

IrradianceMap::Count IrradianceMap::estimate(std::uint32_t i, const PhotonMap& carriers,
                                             const IrradianceOptions& options) {
    const Photon& place = scouts_[i];
    const PhotonQuery query{{place.position(), place.normal().decode()}, options.max_radius, options.k, options.shrink};
    // The scout in the middle is there by choice of the place, so it is no evidence of the density there.
    const float r = scouted_radius(scouts_, query, 1);
    double sum = 0, squares = 0;
    const auto one = [&](const Photon& p) {
        const double power = luminance(p.power());
        sum += power;
        squares += power * power;
        return 1.0;
    };
    DensityEstimate e = options.scene != nullptr ? estimate_density_in_sight(*options.scene, carriers, query.region, r,
                                                                             *options.patches, one)
                                                 : estimate_density(carriers, query.region, r, options.patches, one);
    e.value /= share_in_reach(options.reach, query.region, r);
    estimates_[i] = {SharedExponentRgb(e.value), e.obstructed, r};
    return {static_cast<double>(e.photons), squares > 0 ? sum * sum / squares : 0.0};
}

IrradianceMap::Answer IrradianceMap::irradiance(const Vec3& position, const Vec3& normal) const {
    // Farther than the estimates themselves look: where photons are rare, most places have none that near, and to call
    // them dark would take light away.
    const PhotonQuery query{{position, normal}, 4 * max_radius_, 1};
    const Neighbourhood near = scouts_.nearest(query);
    if (near.found.empty()) return {};
    std::uint32_t place = near.found[0].index;
    const Estimate& nearest = estimates_[place];
    // Whether something stands between is known within the region of the estimate.
    if (scene_ != nullptr && (nearest.obstructed || near.found[0].distance2 > nearest.radius * nearest.radius)) {
        const auto visible = [&](const Photon& p) {
            const float lift = 0.25f * (p.position() - position).length();
            return in_sight(*scene_, query.region, lift, p.position());
        };
        if (!visible(scouts_[place])) {
            const Photon* other = scouts_.nearest_accepted(query, visible);
            if (other == nullptr) return {};
            place = static_cast<std::uint32_t>(other - places().data());
        }
    }
    return {estimates_[place].irradiance.decode(), true, place};
}

} // namespace keyhole
