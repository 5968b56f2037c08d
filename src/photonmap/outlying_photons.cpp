#include "photonmap/outlying_photons.h"

#include "core/parallel.h"
#include "photonmap/confirmation.h"
#include "photonmap/surface/density_in_sight.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace keyhole {
namespace {

/// Of the photons before and after one in the tree, most of which are near it, so many are asked; where that many are
/// near, it is looked at only with so much more power than their mean.
constexpr std::size_t kBeside = 8;
constexpr double kLeastPower = 2;
/// Share of the light of the spot around it that a photon has. Spots of many photons come by chains, which would need
/// to move on.
constexpr double kLeastOfSpot = 0.25;
/// Photons at most, of the brightest discs: where all light is sparse nearly each photon stands alone, and lookups
/// would have to ask many.
constexpr std::size_t kMost = 256;
/// Of a disc's area, that is lit: in a corner it is a quarter. On small things and in folds less of the light is shown,
/// for what lies around them would be as bright.
constexpr double kLeastArea = 0.25;
/// How much wider a region may be than that of a lookup: its light is fainter by the square.
constexpr double kMostWider = 4;

/// Whether photon i may outshine the others within the radius of a lookup at most. To be told quickly: hardly any does.
bool may_outshine(std::span<const Photon> photons, std::size_t i, float max_radius) {
    const std::size_t first = i - std::min(i, kBeside), end = std::min(photons.size(), i + kBeside + 1);
    const float near2 = max_radius * max_radius / 4;
    double near = 0, sum = 0;
    for (const Photon& p : photons.subspan(first, end - first)) {
        if ((p.position() - photons[i].position()).length2() > near2) continue;
        ++near;
        sum += luminance(p.power());
    }
    return near <= kBeside || luminance(photons[i].power()) * near > kLeastPower * sum;
}

/// What a photon lights where it stands alone.
struct Disc {
    float radius = 0;      ///< of the region that it should light [m]; 0: that of a lookup will do
    double brightness = 0; ///< if it lit that of a lookup [W/m^2, without pi]
};

Disc disc_of(const Photon& photon, const PilotedMap& map, PhotonQuery query) {
    query.region = {photon.position(), photon.normal().decode()};
    const float r = piloted_radius(map.pilots(), query);
    const SpotOfRegion spot =
        spot_of_region(map, query.region, r, photon.position(), [](const Photon& p) { return luminance(p.power()); });
    const bool by_others = luminance(photon.power()) < kLeastOfSpot * spot.light;
    if (by_others || !(spot.unconfirmed() > 0)) return {};
    const double others = std::max(spot.all - spot.light, spot.light / (kMostWider * kMostWider));
    return {r * static_cast<float>(std::sqrt(spot.light / others)), spot.light / (static_cast<double>(r) * r)};
}

/// What no more than kMost of the discs exceed; 0 where there are no more.
double brightness_of_most(const std::vector<Disc>& discs) {
    std::vector<double> sorted;
    for (const Disc& d : discs)
        if (d.radius > 0) sorted.push_back(d.brightness);
    if (sorted.size() <= kMost) return 0;
    std::ranges::nth_element(sorted, sorted.begin() + kMost, std::greater());
    return sorted[kMost];
}

} // namespace

OutlyingPhotons::OutlyingPhotons(PilotedMap& map, int k, float max_radius, float shrink, const SurfacePatches* patches)
    : OutlyingPhotons() {
    const std::span<const Photon> all = map.main_photons().photons();
    const PhotonQuery query{{}, max_radius, k, shrink};
    std::vector<Disc> discs(all.size());
    parallel_for(static_cast<std::int64_t>(all.size()), [&](std::int64_t i) {
        const auto at = static_cast<std::size_t>(i);
        if (may_outshine(all, at, shrink * max_radius)) discs[at] = disc_of(all[at], map, query);
    });
    const double bound = brightness_of_most(discs);
    std::vector<Photon> outlying, others;
    for (std::size_t i = 0; i < all.size(); ++i) (discs[i].brightness > bound ? outlying : others).push_back(all[i]);
    if (outlying.empty()) return;
    photons_ = PhotonMap(std::move(outlying));
    for (const Photon& photon : photons_.photons()) {
        const float r = disc_of(photon, map, query).radius; // in the order of their tree
        const SurfaceRegion region{photon.position(), photon.normal().decode()};
        const double disc = kPi * static_cast<double>(r) * r;
        const double area =
            patches != nullptr ? surroundings_of(*patches, region, r, patches->obstructed(region, r)).area : disc;
        lit_.push_back({r, std::clamp(area, kLeastArea * disc, disc)});
        most_ = std::max(most_, r);
    }
    map.set_main_photons(std::move(others));
}

} // namespace keyhole
