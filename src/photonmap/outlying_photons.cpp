#include "photonmap/outlying_photons.h"

#include "core/parallel.h"
#include "photonmap/confirmation.h"
#include "photonmap/surface/density_in_sight.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

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
constexpr std::int64_t kBlock = 1024;
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

/// A photon that stands alone, and what it lights.
struct Disc {
    std::uint32_t photon;
    float radius;      ///< of the region that it should light [m]
    double brightness; ///< if it lit that of a lookup [W/m^2, without pi]
};

std::optional<Disc> disc_of(std::uint32_t i, const PilotedMap& map, PhotonQuery query) {
    const Photon& photon = map.main_photons()[i];
    query.region = {photon.position(), photon.normal().decode()};
    const float r = piloted_radius(map.pilots(), query);
    const SpotOfRegion spot =
        spot_of_region(map, query.region, r, photon.position(), [](const Photon& p) { return luminance(p.power()); });
    const bool by_others = luminance(photon.power()) < kLeastOfSpot * spot.light;
    if (by_others || !(spot.unconfirmed() > 0)) return std::nullopt;
    const double others = std::max(spot.all - spot.light, spot.light / (kMostWider * kMostWider));
    return Disc{i, r * static_cast<float>(std::sqrt(spot.light / others)), spot.light / (static_cast<double>(r) * r)};
}

/// Area of surface around a photon that it lights, up to `radius` away [m^2].
double lit_area(const Photon& photon, float radius, const SurfacePatches* patches) {
    const double disc = kPi * static_cast<double>(radius) * radius;
    if (patches == nullptr) return disc;
    const SurfaceRegion region{photon.position(), photon.normal().decode()};
    const double area = surroundings_of(*patches, region, radius, patches->obstructed(region, radius)).area;
    return std::clamp(area, kLeastArea * disc, disc);
}

/// Of the brightest, in the order of the tree.
std::vector<Disc> brightest_discs(const PilotedMap& map, const PhotonQuery& query) {
    const std::span<const Photon> all = map.main_photons().photons();
    const auto count = static_cast<std::int64_t>(all.size()), blocks = count / kBlock + 1;
    std::vector<std::vector<Disc>> parts(static_cast<std::size_t>(blocks));
    parallel_for(blocks, [&](std::int64_t b) {
        for (std::int64_t i = b * kBlock; i < std::min(count, (b + 1) * kBlock); ++i) {
            if (!may_outshine(all, static_cast<std::size_t>(i), query.shrink * query.max_radius)) continue;
            if (const auto disc = disc_of(static_cast<std::uint32_t>(i), map, query))
                parts[static_cast<std::size_t>(b)].push_back(*disc);
        }
    });
    std::vector<Disc> discs;
    for (const auto& part : parts) discs.insert(discs.end(), part.begin(), part.end());
    if (discs.size() > kMost) {
        std::ranges::stable_sort(discs, std::greater(), &Disc::brightness);
        discs.resize(kMost, discs[0]);
        std::ranges::sort(discs, {}, &Disc::photon);
    }
    return discs;
}

} // namespace

OutlyingPhotons::OutlyingPhotons(PilotedMap& map, int k, float max_radius, float shrink, const SurfacePatches* patches)
    : OutlyingPhotons() {
    const std::vector<Disc> discs = brightest_discs(map, {{}, max_radius, k, shrink});
    std::vector<Photon> outlying;
    for (const Disc& d : discs) outlying.push_back(map.main_photons()[d.photon]);
    photons_ = PhotonMap(std::move(outlying));
    for (const Photon& photon : photons_.photons()) {
        const auto disc =
            std::ranges::find_if(discs, [&](const Disc& d) { return map.main_photons()[d.photon] == photon; });
        lit_.push_back({disc->radius, lit_area(photon, disc->radius, patches)});
        most_ = std::max(most_, disc->radius);
    }
    for (const Disc& d : discs) map.put_out(d.photon);
}

} // namespace keyhole
