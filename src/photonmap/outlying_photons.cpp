#include "photonmap/outlying_photons.h"

#include "core/parallel.h"
#include "photonmap/confirmation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

/// Of the photons before and after one in the tree, most of which are near it, so many are asked; where that many are
/// near, it is looked at only with so much more power than their mean.
constexpr std::size_t kBeside = 8;
constexpr double kLeastPower = 2;
/// Share of the light of the spot around it that a photon has. Spots of many photons come by chains, which would need
/// to move on.
constexpr double kLeastOfSpot = 0.25;
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

/// Radius of the region that a photon lights [m]; 0: that of lookups will do.
float wide_radius(const Photon& photon, const PilotedMap& map, PhotonQuery query) {
    query.region = {photon.position(), photon.normal().decode()};
    const float r = piloted_radius(map.pilots(), query);
    const SpotOfRegion spot =
        spot_of_region(map, query.region, r, photon.position(), [](const Photon& p) { return luminance(p.power()); });
    const bool by_others = luminance(photon.power()) < kLeastOfSpot * spot.light;
    if (by_others || !(spot.unconfirmed() > 0)) return 0;
    const double others = std::max(spot.all - spot.light, spot.light / (kMostWider * kMostWider));
    return r * static_cast<float>(std::sqrt(spot.light / others));
}

} // namespace

OutlyingPhotons::OutlyingPhotons(PilotedMap& map, int k, float max_radius, float shrink) : OutlyingPhotons() {
    const std::span<const Photon> all = map.main_photons().photons();
    const PhotonQuery query{{}, max_radius, k, shrink};
    std::vector<float> radii(all.size());
    parallel_for(static_cast<std::int64_t>(all.size()), [&](std::int64_t i) {
        const auto at = static_cast<std::size_t>(i);
        if (may_outshine(all, at, shrink * max_radius)) radii[at] = wide_radius(all[at], map, query);
    });
    std::vector<Photon> outlying, others;
    for (std::size_t i = 0; i < all.size(); ++i) (radii[i] > 0 ? outlying : others).push_back(all[i]);
    if (outlying.empty()) return;
    photons_ = PhotonMap(std::move(outlying));
    for (const Photon& photon : photons_.photons()) {
        radii_.push_back(wide_radius(photon, map, query)); // in the order of their tree
        most_ = std::max(most_, radii_.back());
    }
    map.set_main_photons(std::move(others));
}

} // namespace keyhole
