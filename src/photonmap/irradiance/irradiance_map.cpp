#include "photonmap/irradiance/irradiance_map.h"

#include "core/shared_work.h"
#include "photonmap/surface/density_in_sight.h"

#include <algorithm>

namespace keyhole {
namespace {

/// How high above the surface two places are tested for sight of each other, as a share of their distance.
constexpr float kLift = 0.25f;
/// How far from a place the middle of its photons' power lies, over the radius, where their light is one-sided: that of
/// a half disc lies at 0.42.
constexpr double kOffCentre = 0.5;
constexpr unsigned kLevels = 8;

/// Radius of an estimate over the free height above its place, at most. In a crevice light changes over the crevice's
/// width, and a wider mean would have the light of the room before it.
constexpr float kMostOfFreeHeight = 2;

/// Distance of a place over the largest radius of estimates. Farther than the estimates themselves look: where photons
/// are rare, most places have none that near, and to call them dark would take light away.
constexpr float kFarthest = 4;
/// After so many places that are hidden, only one in so many of those that follow is tested for sight: in a crevice
/// none is seen, and there may be thousands in reach. Behind a wall those of this side may be few.
constexpr int kTestedAll = 32;
constexpr std::uint32_t kTestedThen = 4;
/// Size of a cell for which one place will do, over the radius of its estimate.
constexpr float kMostOfRadius = 1;

/// Bit i is set if something may stand on the region of radius r / 2^i. It looks from half to three halves of the
/// height kLift r / 2^i, where lines of sight run between places that are more than half as far from each other.
std::uint8_t obstructed_levels(const SurfacePatches& patches, const SurfaceRegion& region, float r) {
    unsigned levels = 0;
    for (unsigned i = 0; i < kLevels; ++i, r /= 2) levels |= patches.obstructed(region, r) ? 1u << i : 0u;
    return static_cast<std::uint8_t>(levels);
}

} // namespace

IrradianceMap::IrradianceMap(const PhotonMap& pilots, const PhotonMap& main_photons, const IrradianceOptions& options,
                             const RunContext& context)
    : pilots_(pilots), estimates_(pilots.photons().size()), max_radius_(options.max_radius), scene_(options.scene),
      patches_(options.patches), most_hidden_(options.most_hidden) {
    if (options.by_length) shares_.resize(estimates_.size());
    const Range own = own_part(static_cast<std::int64_t>(estimates_.size()), context);
    std::vector<Count> used(static_cast<std::size_t>(blocks_of(own)));
    const ProgressStage progress(context, "irradiance", own.size(), "estimates");
    shared_blocks(estimates_, context, [&](std::int64_t b, std::int64_t i) {
        used[static_cast<std::size_t>(b)] += estimate(static_cast<std::uint32_t>(i), main_photons, options);
    });
    exchange_parts(shares_, context);
    if (options.scene != nullptr)
        grid_.emplace(
            options.scene->shapes(), std::max(options.grid_bytes, kGridBytesPerPlace * estimates_.size()),
            [this](const Vec3& middle, const Vec3& normal) { return place_for_cell(middle, normal); }, context);
    if (own.size() == 0) return;
    for (const Count& u : used) mean_ += u;
    mean_.photons /= static_cast<double>(own.size());
    mean_.effective /= static_cast<double>(own.size());
}

IrradianceMap::Count IrradianceMap::estimate(std::uint32_t i, const PhotonMap& main_photons,
                                             const IrradianceOptions& options) {
    const Photon& place = pilots_[i];
    const PhotonQuery query{{place.position(), place.normal().decode()}, options.max_radius, options.k, options.shrink};
    // The pilot photon in the middle is there by choice of the place, so it is no evidence of the density there.
    const float expected = piloted_radius(pilots_, query, 1);
    const bool by_sight = options.scene != nullptr;
    const float r = by_sight
                        ? std::min(expected, kMostOfFreeHeight * options.patches->free_height(query.region, expected))
                        : expected;
    double sum = 0, squares = 0;
    Imath::V3d moment(0.0);
    unsigned marks = 0;
    std::array<double, kLongerWays> reaching{}; // power of what may take 1, 2, ... vertices more
    const auto one = [&](const Photon& p) {
        const double power = luminance(p.power());
        sum += power;
        squares += power * power;
        moment += power * Imath::V3d(p.position() - place.position());
        if (p.caustic()) marks |= Estimate::caustics;
        for (int k = 0; k < std::min(p.spare(), kLongerWays); ++k) reaching[static_cast<std::size_t>(k)] += power;
        return 1.0;
    };
    DensityEstimate e =
        by_sight ? estimate_density_in_sight(*options.scene, main_photons, query.region, r, *options.patches, one)
                 : estimate_density(main_photons, query.region, r, options.patches, one);
    e.value /= share_in_reach(options.coverage, query.region, r);
    if (r < expected || moment.length() > kOffCentre * sum * r) marks |= Estimate::in_crevice;
    const double disc = kPi * static_cast<double>(r) * r;
    estimates_[i] = Estimate(e.value, marks, r, disc > 0 ? e.area / disc : 0.0,
                             e.obstructed ? obstructed_levels(*options.patches, query.region, r) : std::uint8_t{0});
    if (!shares_.empty() && sum > 0)
        std::ranges::transform(reaching, shares_[i].begin(),
                               [&](double r) { return static_cast<std::uint8_t>(std::lround(255 * r / sum)); });
    return {static_cast<double>(e.photons), squares > 0 ? sum * sum / squares : 0.0};
}

SurfaceLookupGrid::Found IrradianceMap::place_for_cell(const Vec3& middle, const Vec3& normal) const {
    const auto near = pilots_.nearest_one({middle, normal}, kFarthest * max_radius_, PhotonMap::Expected::none);
    if (!near) return {SurfaceLookupGrid::kNothing, max_radius_};
    return {near->index, kMostOfRadius * radius(near->index)};
}

IrradianceMap::Answer IrradianceMap::irradiance(const Vec3& position, const Vec3& normal) const {
    const SurfaceRegion region{position, normal};
    const auto near = pilots_.nearest_one(region, kFarthest * max_radius_);
    return near ? answer(near->index, region) : Answer{};
}

IrradianceMap::Answer IrradianceMap::irradiance(const SurfacePoint& point, const Vec3& normal) const {
    const std::uint32_t place = grid_ ? grid_->at(point, normal) : SurfaceLookupGrid::kSearch;
    if (place == SurfaceLookupGrid::kSearch) return irradiance(point.p, normal);
    return place == SurfaceLookupGrid::kNothing ? Answer{} : answer(place, {point.p, normal});
}

IrradianceMap::Answer IrradianceMap::answer(std::uint32_t place, const SurfaceRegion& region) const {
    if (!may_be_hidden(place, region)) return {estimates_[place].irradiance(), true, place};
    // Under a low board the line of sight must not run above it.
    const float highest = patches_->free_height(region, radius(place)) / 2;
    const auto visible = [&](const Photon& p) {
        const float lift = std::min(highest, kLift * (p.position() - region.position).length());
        return in_sight(*scene_, region, lift, p.position());
    };
    if (!visible(pilots_[place])) {
        int hidden = 0;
        std::optional<std::uint32_t> seen; // the nearest one so far
        (void)pilots_.nearest_accepted(region, kFarthest * max_radius_, [&](const Photon& p) {
            const auto i = static_cast<std::uint32_t>(&p - pilots_.photons().data());
            if (hidden >= most_hidden_) return true; // given up: what is accepted now only ends the search
            if (hidden >= kTestedAll && i % kTestedThen != 0) return false;
            if (!visible(p)) {
                ++hidden;
                return false;
            }
            seen = i;
            return true;
        });
        if (!seen) return {};
        place = *seen;
    }
    return {estimates_[place].irradiance(), true, place};
}

bool IrradianceMap::may_be_hidden(std::uint32_t place, const SurfaceRegion& region) const {
    if (scene_ == nullptr) return false;
    const Estimate& e = estimates_[place];
    const float d2 = region.distance2(pilots_[place].position());
    float reach2 = e.radius() * e.radius();
    // Nothing is known of what stands beyond the region of the estimate.
    if (d2 > reach2) return true;
    for (unsigned levels = e.obstructed(); levels != 0; levels >>= 1, reach2 /= 4)
        if (d2 > reach2 / 4) return (levels & 1) != 0;
    return false;
}

} // namespace keyhole
