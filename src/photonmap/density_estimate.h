// Densities from the nearest photons.
#pragma once

#include "photonmap/photon_map.h"
#include "photonmap/surface/surface_patches.h"

namespace keyhole {

/// What is to have the right expectation: the density, for a picture, or its reciprocal, for dividing by the density.
enum class Unbiased {
    /// (k-1) / A_k: the k-th photon sets the region's border and doesn't count. Exact in expectation for photons
    /// thrown with locally uniform density, also where max_radius cuts the region off.
    density,
    /// k / A_k: A_k / k has the expectation of the reciprocal density (Booth 2007, Suykens 2000). Where max_radius
    /// cuts in, n / A, which has no such property: no photon at all is a possible outcome.
    reciprocal,
};

struct DensityEstimate {
    Rgb value{0.0};          ///< [1/m^2] times the unit of power times that of the weight
    int photons = 0;         ///< that went into it
    double area = 0;         ///< of the region [m^2]
    float radius = 0;        ///< of the region [m]
    bool obstructed = false; ///< something stands on the region, where somebody asked for that
};

/// Sum over the region's photons of weight(photon) * power / area, constant kernel.
///
/// With `weight` the BSDF for light from photon.direction() this is reflected radiance. Power is flux through the
/// geometric surface: where the shading normal differs, a weight that agrees with path tracing has the factor |wi.ns| /
/// |wi.ng| (measure.h). The area is that of the surface inside the region if `patches` are given, otherwise that of the
/// disc, which is too large at edges and on curved surfaces. k = 1 under Unbiased::density is always 0. A region
/// without area (all photons on one spot) yields 0. In a region that
/// the query shrinks the photons inside are as many as chance has it, so Unbiased::density holds there as well.
/// `weight` must not query a photon map.
template <class Weight>
DensityEstimate estimate_density(const PhotonMap& map, const PhotonQuery& query, Unbiased unbiased,
                                 const SurfacePatches* patches, Weight&& weight) {
    const Neighbourhood near = map.nearest(query);
    const double radius2 = near.radius2 * static_cast<double>(query.shrink) * query.shrink;
    DensityEstimate e;
    e.radius = static_cast<float>(std::sqrt(radius2));
    e.area = patches != nullptr ? patches->area(query.region, std::sqrt(radius2)) : kPi * radius2;
    if (!(e.area > 0)) return e;
    const std::size_t first = near.full && unbiased == Unbiased::density ? 1 : 0;
    for (const Neighbour& n : near.found.subspan(first)) {
        if (n.distance2 > radius2) continue;
        const Photon& photon = map[n.index];
        e.value += weight(photon) * photon.power();
        ++e.photons;
    }
    e.value /= e.area;
    return e;
}

/// The same over a region of radius `radius` [m] that doesn't follow from the photons of `map`, in which `area` [m^2]
/// of surface lies. `weight` may ask maps for what is nearest, but not for what is within a radius.
template <class Weight>
DensityEstimate estimate_density(const PhotonMap& map, const SurfaceRegion& region, float radius, double area,
                                 Weight&& weight) {
    DensityEstimate e;
    e.radius = radius;
    e.area = area;
    if (!(e.area > 0)) return e;
    map.for_each_within(region, radius, [&](const Photon& photon) {
        e.value += weight(photon) * photon.power();
        ++e.photons;
    });
    e.value /= e.area;
    return e;
}

/// The same with the area that `patches` tell; null: that of the disc.
template <class Weight>
DensityEstimate estimate_density(const PhotonMap& map, const SurfaceRegion& region, float radius,
                                 const SurfacePatches* patches, Weight&& weight) {
    const double area = patches != nullptr ? patches->area(region, radius) : kPi * static_cast<double>(radius) * radius;
    return estimate_density(map, region, radius, area, std::forward<Weight>(weight));
}

} // namespace keyhole
