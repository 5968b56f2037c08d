#include "gather/bright_spots.h"

#include "core/parallel.h"
#include "gather/visible_point.h"
#include "sampling/image_lattice.h"
#include "scene/warp.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

constexpr std::int64_t kRays = 32'768;
constexpr float kCellsAcross = 96; // the scene's diagonal
constexpr std::size_t kMostSpots = 64;
constexpr double kLeastShare = 0.002; // of the second moment of what rays bring
constexpr double kContrast = 10;      // that share over the share of the rays

/// What one ray brought, and from where.
struct Finding {
    Vec3 place{0, 0, 0};
    double radiance = -1; ///< luminance; negative: nothing was met
};

Finding find(const GatherRays& rays, std::uint64_t seed, std::int64_t i) {
    Rng rng(seed, StreamPurpose::bright_spots, static_cast<std::uint64_t>(i));
    const auto from = visible_point(rays, lattice_image_point(seed, StreamPurpose::bright_spots, i), rng);
    if (!from) return {};
    const Frame frame(cache_normal(from->vertex, from->back));
    const double u0 = rng.next(), u1 = rng.next();
    const Vec3 local = cosine_hemisphere(u0, u1), w = frame.to_world(local);
    if (!from->leaves(w)) return {};
    const auto arrival = rays.trace(from->vertex, w, local.z * kInvPi, from->scatterings, rng);
    if (!std::isfinite(arrival.distance)) return {};
    return {from->vertex.point.p + w * arrival.distance, luminance(arrival.indirect)};
}

struct Cell {
    std::uint64_t key;
    Vec3 place; ///< any in it
    double sum = 0, sum2 = 0;
    double rays = 0;
};

} // namespace

BrightSpots::BrightSpots(const GatherRays& rays, std::uint64_t seed, const RunContext& context)
    : origin_(rays.scene().lower()),
      width_(std::max((rays.scene().upper() - rays.scene().lower()).length() / kCellsAcross, 1e-20f)),
      radius_(width_ * std::sqrt(3.0f) / 2) {
    std::vector<Finding> findings(kRays);
    context.begin("bright spots", kRays, "rays");
    parallel_for(kRays / 64, [&](std::int64_t b) {
        for (std::int64_t i = b * 64; i < (b + 1) * 64; ++i)
            findings[static_cast<std::size_t>(i)] = find(rays, seed, i);
        context.advance(64);
    });
    context.end();

    std::unordered_map<std::uint64_t, std::size_t> places;
    std::vector<Cell> cells;
    double sum2 = 0, met = 0;
    for (const Finding& f : findings) {
        if (f.radiance < 0) continue;
        const auto [at, is_new] = places.try_emplace(cell(f.place), cells.size());
        if (is_new) cells.push_back({at->first, f.place});
        Cell& c = cells[at->second];
        c.sum += f.radiance;
        c.sum2 += f.radiance * f.radiance;
        ++c.rays;
        sum2 += f.radiance * f.radiance;
        ++met;
    }
    std::stable_sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.sum2 > b.sum2; });
    for (const Cell& c : cells) {
        if (spots_.size() == kMostSpots || !(c.sum2 > kLeastShare * sum2)) break;
        if (c.sum2 / sum2 < kContrast * c.rays / met) continue;
        const Vec3 in_cells = (c.place - origin_) / width_;
        const Vec3 corner(std::floor(in_cells.x), std::floor(in_cells.y), std::floor(in_cells.z));
        share_ += c.sum2 / sum2;
        index_.emplace(c.key, static_cast<int>(spots_.size()));
        spots_.push_back({origin_ + (corner + Vec3(0.5f)) * width_, c.sum / c.rays});
    }
}

std::uint64_t BrightSpots::cell(const Vec3& place) const {
    const Vec3 in_cells = (place - origin_) / width_;
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k)
        key = key << 20 | (static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(in_cells[k]))) & 0xFFFFF);
    return key;
}

int BrightSpots::spot_at(const Vec3& place) const {
    if (spots_.empty() || !std::isfinite(place.length2())) return -1;
    const auto found = index_.find(cell(place));
    return found == index_.end() ? -1 : found->second;
}

std::vector<SpotCone> BrightSpots::cones_from(const Vec3& p, const Vec3& n, int rays) const {
    std::vector<SpotCone> cones;
    std::vector<double> worth;
    double total = 0;
    for (std::size_t i = 0; i < spots_.size(); ++i) {
        const Vec3 to = spots_[i].centre - p;
        const double distance = static_cast<double>(to.length());
        if (distance < 1.2 * static_cast<double>(radius_)) continue;
        const double sine = static_cast<double>(radius_) / distance;
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
