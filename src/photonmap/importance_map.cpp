#include "photonmap/importance_map.h"

#include "sampling/measure.h"

namespace keyhole {

ImportanceMap::Importance ImportanceMap::importance(const SurfacePoint& d2, const Bsdf& bsdf,
                                                    const Vec3& to_light) const {
    const Vec3 normal = d2.ng.dot(to_light) < 0 ? -d2.ng : d2.ng;
    const PhotonQuery query{{d2.p, normal}, options_.max_radius, options_.k};
    const auto scattering = [&](const Photon& importon) {
        return scatter(d2, bsdf, Event::finite, to_light, importon.direction()).value;
    };
    const DensityEstimate e = estimate_density(map_, query, options_.unbiased, options_.patches, scattering);
    return {e.value, e.photons};
}

} // namespace keyhole
