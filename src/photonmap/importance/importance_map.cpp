#include "photonmap/importance/importance_map.h"

#include "sampling/paths/measure.h"

namespace keyhole {

ImportanceMap::Importance ImportanceMap::importance(const SurfacePoint& d2, const Bsdf& bsdf, const Vec3& to_light,
                                                    Ways ways, int longest) const {
    const PhotonQuery query{{d2.p, facing(d2.ng, to_light)}, options_.max_radius, options_.k};
    const auto scattering = [&](const Photon& importon) {
        if (ways == Ways::specular && !importon.caustic()) return Rgb(0.0);
        if (importon.spare() > longest) return Rgb(0.0);
        return scatter(d2, bsdf, Event::finite, to_light, importon.direction()).value;
    };
    const DensityEstimate e = estimate_density(map_, query, options_.unbiased, options_.patches, scattering);
    // With few importons the reciprocal of n has a heavy tail; that of n + 1 has the right expectation for a Poisson
    // count.
    const bool few = e.photons > 0 && e.photons < options_.k;
    const bool obstructed = options_.patches != nullptr && options_.patches->obstructed(query.region, e.radius);
    return {few ? e.value * (1 + 1.0 / e.photons) : e.value, e.photons, obstructed};
}

} // namespace keyhole
