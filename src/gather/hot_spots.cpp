#include "gather/hot_spots.h"

#include "core/shared_work.h"
#include "gather/visible_point.h"
#include "sampling/paths/image_lattice.h"
#include "scene/warp.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keyhole {
namespace {

constexpr int kDepth = 8;            // of the tree: cells are at least 1/256 of the scene's width
constexpr double kEnough = 10;       // bright rays that tell how light is spread over a cell's children
constexpr double kFew = 8;           // bright rays that don't tell where in the cell it ends
constexpr double kDim = 0.005;       // share of a cell's second moment that a ray needs to be one of its bright ones
constexpr float kMargin = 1.5f;      // of the ball around the bright places that were found
constexpr float kLeastBall = 0.125f; // its radius over that of the cell
constexpr std::size_t kMostSpots = 64;
constexpr double kLeastShare = 0.002; // of the second moment of what rays bring
constexpr double kContrast = 10;      // that share over the share of the rays

} // namespace

HotSpots::Finding HotSpots::find(const GatherRays& rays, std::uint64_t seed, std::int64_t i) {
    Rng rng(seed, StreamPurpose::hot_spots, static_cast<std::uint64_t>(i));
    const auto from = visible_point(rays, lattice_image_point(seed, StreamPurpose::hot_spots, i), rng);
    if (!from) return {};
    const Frame frame(cache_normal(from->vertex, from->back));
    const double u0 = rng.next(), u1 = rng.next();
    const Vec3 local = cosine_hemisphere(u0, u1), w = frame.to_world(local);
    if (!from->leaves(w)) return {};
    const auto arrival = rays.trace(from->vertex, w, local.z * kInvPi, from->scatterings, rng);
    if (!std::isfinite(arrival.distance)) return {};
    return {from->vertex.point.p + w * arrival.distance, luminance(arrival.indirect)};
}

std::size_t HotSpots::Cell::octant(const Vec3& place) const {
    return (place.x >= centre.x ? 1 : 0) + (place.y >= centre.y ? 2 : 0) + (place.z >= centre.z ? 4 : 0);
}

HotSpots::Cell HotSpots::Cell::child(std::size_t octant) const {
    const auto side = [&](std::size_t bit) { return (octant & bit) != 0 ? width / 4 : -width / 4; };
    return {centre + Vec3(side(1), side(2), side(4)), width / 2};
}

HotSpots::HotSpots(const GatherRays& rays, std::int64_t count, std::uint64_t seed, const RunContext& context)
    : nodes_(1) {
    const Vec3 lower = rays.scene().lower(), extent = rays.scene().upper() - lower;
    root_ = {lower + extent / 2, std::max({extent.x, extent.y, extent.z})};

    constexpr std::int64_t kBlock = 64;
    std::vector<Finding> findings(static_cast<std::size_t>(count));
    context.begin("hot spots", static_cast<std::uint64_t>(count), "rays");
    parallel_for((count + kBlock - 1) / kBlock, context, [&](std::int64_t b) {
        const std::int64_t end = std::min(count, (b + 1) * kBlock);
        for (std::int64_t i = b * kBlock; i < end; ++i) findings[static_cast<std::size_t>(i)] = find(rays, seed, i);
        context.advance(static_cast<std::uint64_t>(end - b * kBlock));
    });
    context.end();

    std::erase_if(findings, [](const Finding& f) { return f.radiance < 0; });
    Whole whole;
    for (const Finding& f : findings) whole.sum2 += f.radiance * f.radiance;
    whole.rays = static_cast<double>(findings.size());
    if (whole.sum2 > 0) divide(0, root_, findings, whole, 0);
    keep_the_brightest();
}

void HotSpots::divide(std::size_t node, const Cell& cell, std::span<Finding> findings, const Whole& whole, int depth) {
    double sum2 = 0, sum4 = 0;
    for (const Finding& f : findings) {
        sum2 += f.radiance * f.radiance;
        sum4 += std::pow(f.radiance, 4);
    }
    if (!(sum2 > kLeastShare * whole.sum2)) return;
    const double effective = sum2 * sum2 / sum4; // rays that the second moment comes from
    if (depth == kDepth || effective < kEnough) {
        const double rays = static_cast<double>(findings.size()), share = sum2 / whole.sum2;
        if (share < kContrast * rays / whole.rays) return;
        nodes_[node].spot = static_cast<int>(spots_.size());
        spots_.push_back(spot_of(cell, findings, sum2, effective, share));
        return;
    }
    const std::size_t first = nodes_.size();
    nodes_[node].children = static_cast<int>(first);
    nodes_.resize(first + 8);
    std::ranges::stable_sort(findings, {}, [&](const Finding& f) { return cell.octant(f.place); });
    auto rest = findings.begin();
    for (std::size_t k = 0; k < 8; ++k) {
        const auto end =
            std::find_if(rest, findings.end(), [&](const Finding& f) { return cell.octant(f.place) != k; });
        divide(first + k, cell.child(k), std::span(rest, end), whole, depth + 1);
        rest = end;
    }
}

HotSpots::Spot HotSpots::spot_of(const Cell& cell, std::span<const Finding> findings, double sum2, double effective,
                                 double share) {
    const float around = cell.width * std::sqrt(3.0f) / 2;
    Spot spot{cell.centre, around, 0, share};
    if (effective >= kFew) {
        Vec3 middle(0);
        for (const Finding& f : findings) middle += f.place * static_cast<float>(f.radiance * f.radiance / sum2);
        float reach = kLeastBall * around / kMargin;
        for (const Finding& f : findings)
            if (f.radiance * f.radiance > kDim * sum2) reach = std::max(reach, (f.place - middle).length());
        if (kMargin * reach < around) spot = {middle, kMargin * reach, 0, share};
    }
    double inside2 = 0, inside = 0;
    for (const Finding& f : findings) {
        if ((f.place - spot.centre).length() > spot.radius) continue;
        inside2 += f.radiance * f.radiance;
        ++inside;
    }
    spot.radiance = std::sqrt(inside2 / std::max(inside, 1.0));
    return spot;
}

void HotSpots::keep_the_brightest() {
    std::vector<int> order(spots_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::ranges::greater{},
                             [&](int i) { return spots_[static_cast<std::size_t>(i)].share; });
    order.resize(std::min(order.size(), kMostSpots));
    std::vector<int> renamed(spots_.size(), -1);
    std::vector<Spot> kept;
    for (const int i : order) {
        renamed[static_cast<std::size_t>(i)] = static_cast<int>(kept.size());
        kept.push_back(spots_[static_cast<std::size_t>(i)]);
        share_ += kept.back().share;
    }
    for (Node& n : nodes_)
        if (n.spot >= 0) n.spot = renamed[static_cast<std::size_t>(n.spot)];
    spots_ = std::move(kept);
}

int HotSpots::spot_at(const Vec3& place) const {
    const Vec3 d = place - root_.centre;
    if (spots_.empty() || !(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) <= root_.width / 2)) return -1;
    Cell cell = root_;
    const Node* node = nodes_.data();
    while (node->children >= 0) {
        const std::size_t k = cell.octant(place);
        node = &nodes_[static_cast<std::size_t>(node->children) + k];
        cell = cell.child(k);
    }
    if (node->spot < 0) return -1;
    const Spot& spot = spots_[static_cast<std::size_t>(node->spot)];
    return (place - spot.centre).length2() <= spot.radius * spot.radius ? node->spot : -1;
}

std::vector<SpotCone> HotSpots::cones_from(const Vec3& p, const Vec3& n, int rays) const {
    std::vector<SpotCone> cones;
    std::vector<double> worth;
    double total = 0;
    for (std::size_t i = 0; i < spots_.size(); ++i) {
        const Vec3 to = spots_[i].centre - p;
        const double distance = static_cast<double>(to.length());
        const auto radius = static_cast<double>(spots_[i].radius);
        if (distance < 1.2 * radius) continue;
        const double sine = radius / distance;
        const double cosine = static_cast<double>(to.dot(n)) / distance;
        if (cosine <= -sine) continue; // below the horizon
        const Vec3 axis = to.normalized();
        cones.push_back({static_cast<int>(i), axis, std::sqrt(1 - sine * sine), 0});
        worth.push_back(spots_[i].radiance * cones.back().solid_angle() * std::max(cosine, sine));
        total += worth.back();
    }
    for (std::size_t i = 0; i < cones.size(); ++i)
        cones[i].rays = static_cast<int>(std::lround(rays * share_ * worth[i] / total));
    std::erase_if(cones, [](const SpotCone& cone) { return cone.rays == 0; });
    return cones;
}

} // namespace keyhole
