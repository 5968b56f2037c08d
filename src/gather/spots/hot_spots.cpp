#include "gather/spots/hot_spots.h"

#include "core/shared_work.h"
#include "gather/spots/bright_balls.h"
#include "gather/visible_point.h"
#include "sampling/paths/image_lattice.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace keyhole {
namespace {

/// What a gather ray brings of indirect light, and from where; none if it meets nothing.
std::optional<RadianceSample> find(const GatherRays& rays, std::uint64_t seed, std::int64_t i) {
    Rng rng(seed, StreamPurpose::hot_spots, static_cast<std::uint64_t>(i));
    const auto ray = first_gather_ray(rays, lattice_image_point(seed, StreamPurpose::hot_spots, i), rng);
    if (!ray) return {};
    const VisiblePoint& from = ray->from;
    const auto arrival = rays.trace(from.vertex, ray->w, ray->pdf, from.scatterings, rng);
    if (!std::isfinite(arrival.distance)) return {};
    return RadianceSample{from.vertex.point.p + ray->w * arrival.distance, arrival.distance,
                          luminance(arrival.indirect)};
}

} // namespace

HotSpots::HotSpots(const GatherRays& rays, std::int64_t count, std::uint64_t seed, const RunContext& context) {
    constexpr std::int64_t kBlock = 64;
    std::vector<RadianceSample> samples;
    {
        const ProgressStage progress(context, "hot spots", count, "rays");
        const auto look = [&](Range range) {
            std::vector<RadianceSample> found;
            for (std::int64_t i = range.begin; i < range.end; ++i)
                if (const auto sample = find(rays, seed, i)) found.push_back(*sample);
            context.advance(range.size());
            return found;
        };
        for (const auto& found : make_blocks({0, count}, kBlock, context, look))
            samples.insert(samples.end(), found.begin(), found.end());
    }
    for (const BrightBall& ball : find_bright_balls(samples).balls) {
        if (spots_.size() == kMost) break;
        double sum2 = 0, inside = 0;
        for (const RadianceSample& f : samples) {
            if ((f.place - ball.centre).length2() > ball.radius * ball.radius) continue;
            sum2 += f.radiance * f.radiance;
            ++inside;
        }
        spots_.push_back({ball.centre, ball.radius, std::sqrt(sum2 / std::max(inside, 1.0))});
        share_ += ball.share;
    }
}

std::optional<SpotCone> HotSpots::cone_of(std::size_t i, const Vec3& p, const Vec3& n) const {
    const Vec3 to = spots_[i].centre - p;
    const double distance = static_cast<double>(to.length());
    const auto radius = static_cast<double>(spots_[i].radius);
    if (distance < 1.2 * radius) return std::nullopt;
    const double sine = radius / distance;
    const double cosine = static_cast<double>(to.dot(n)) / distance;
    if (cosine <= -sine) return std::nullopt; // below the horizon
    SpotCone cone{static_cast<int>(i), to / static_cast<float>(distance), std::sqrt(1 - sine * sine), 0};
    cone.irradiance = spots_[i].radiance * cone.solid_angle() * std::max(cosine, sine);
    return cone;
}

std::vector<SpotCone> HotSpots::cones_from(const Vec3& p, const Vec3& n) const {
    std::vector<SpotCone> cones;
    for_each_cone(p, n, [&](const SpotCone& cone) { cones.push_back(cone); });
    return cones;
}

std::vector<SpotCone> HotSpots::cones_from(const Vec3& p, const Vec3& n, int rays) const {
    std::vector<SpotCone> cones = cones_from(p, n);
    double total = 0;
    for (const SpotCone& cone : cones) total += cone.irradiance;
    if (!(total > 0)) return {}; // cones so narrow that their solid angles are 0
    for (SpotCone& cone : cones) cone.rays = static_cast<int>(std::lround(rays * share_ * cone.irradiance / total));
    std::erase_if(cones, [](const SpotCone& cone) { return cone.rays == 0; });
    return cones;
}

} // namespace keyhole
