// Densities of photons beside walls that stand on a surface.
#pragma once

#include "photonmap/density_estimate.h"
#include "photonmap/surface/sight.h"

namespace keyhole {

/// `weight` of the photons that the middle of a region of radius `r` sees, and 0 of the others. Refers to all it is
/// given.
template <class Weight>
auto weight_in_sight(const Scene& scene, const SurfaceRegion& region, float r, const Weight& weight) {
    return [&, lift = sight_lift(r)](const Photon& p) {
        return in_sight(scene, region, lift, p.position()) ? weight(p) : decltype(weight(p))(0.0);
    };
}

/// What a density estimate over a region divides by.
struct Surroundings {
    double area = 0;              ///< of the surface in the region, or of what of it the middle sees [m^2]
    bool partly_occluded = false; ///< only photons in sight of the middle count, and `area` is what it sees
};

/// Those of a region of radius `r`; `obstructed`: what `patches` say of it.
inline Surroundings surroundings_of(const SurfacePatches& patches, const SurfaceRegion& region, float r,
                                    bool obstructed) {
    // Where nothing is in sight the middle lies in a crevice, and the test says nothing.
    const double seen = obstructed ? patches.area_in_sight(region, r, sight_lift(r)) : 0;
    return {seen > 0 ? seen : patches.area(region, r), seen > 0};
}

/// estimate_density() over a region of radius `r` from what its middle sees, where something stands on it that could
/// hide photons of the other side.
template <class Weight>
DensityEstimate estimate_density_in_sight(const Scene& scene, const PhotonMap& map, const SurfaceRegion& region,
                                          float r, const SurfacePatches& patches, const Weight& weight) {
    const bool obstructed = patches.obstructed(region, r);
    const Surroundings around = surroundings_of(patches, region, r, obstructed);
    DensityEstimate e = around.partly_occluded
                            ? estimate_density(map, region, r, around.area, weight_in_sight(scene, region, r, weight))
                            : estimate_density(map, region, r, around.area, weight);
    e.obstructed = obstructed;
    return e;
}

} // namespace keyhole
