#include "gather/compute_record.h"

#include "core/kronecker.h"
#include "scene/warp.h"

#include <algorithm>

namespace keyhole {
namespace {

/// Scatterings between the eye and a record's rays. Records serve whoever looks, by mirrors and through glass as well,
/// and tell apart what may come that way.
constexpr int kSeenStraight = 1;

/// Adds what of the light of a ray, which adds `luminance` to an irradiance, may take longer ways.
void add(LongerWays& sum, const GatherRays::Arrival& arrival, double added) {
    const double all = luminance(arrival.indirect);
    if (!(all > 0)) return;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += static_cast<float>(added * arrival.reaching[k] / all);
}

} // namespace

IrradianceRecord RecordMaker::compute(const VisiblePoint& c, int count, std::uint64_t stream) const {
    return {c.vertex.point.p,
            cache_normal(c.vertex, c.back),
            light(c, count, stream),
            min_radius(c),
            static_cast<float>(options_.max_radius * c.pixel),
            static_cast<float>(options_.min_radius_by_light * c.pixel)};
}

HemisphereEstimate RecordMaker::light(const VisiblePoint& c, int count, std::uint64_t stream) const {
    Rng rng(options_.seed, StreamPurpose::cache, stream);
    const HemisphereGrid grid(count);
    const Frame frame(cache_normal(c.vertex, c.back));
    const std::vector<SpotCone> cones = spots_.cones_from(c.vertex.point.p, frame.n, count / 2);
    std::vector<HemisphereRay> found(static_cast<std::size_t>(grid.size()));
    LongerWays reaching{};
    for (int i = 0; i < grid.size(); ++i) {
        const double u0 = rng.next(), u1 = rng.next();
        const Vec3 local = grid.direction(i, u0, u1), w = frame.to_world(local);
        HemisphereRay& ray = found[static_cast<std::size_t>(i)];
        ray.distance = std::numeric_limits<float>::infinity();
        if (!c.leaves(w)) continue;
        const auto arrival = rays_.trace(c.vertex, w, local.z * kInvPi, kSeenStraight, rng);
        // What lies nearer than the least reach can't be told apart anyway.
        ray.distance = std::max(arrival.distance, min_radius(c));
        if (!spot_of(c.vertex.point.p + w * arrival.distance, cones))
            ray.radiance = arrival.indirect * c.vertex.bsdf.diffuse_weight(w);
        add(reaching, arrival, luminance(ray.radiance) * kPi / grid.size());
    }
    HemisphereEstimate sum = grid.estimate(found, frame);
    sum.reaching = reaching;
    for (const SpotCone& cone : cones) add_spot(c, frame, cone, cones, rng, sum);
    const auto all = static_cast<float>(luminance(sum.irradiance));
    for (float& share : sum.reaching) share = all > 0 ? std::min(1.0f, share / all) : 1;
    return sum;
}

const SpotCone* RecordMaker::spot_of(const Vec3& place, std::span<const SpotCone> cones) const {
    const auto at =
        std::ranges::find_if(cones, [&](const SpotCone& cone) { return spots_.contains(cone.spot, place); });
    return at != cones.end() ? &*at : nullptr;
}

void RecordMaker::add_spot(const VisiblePoint& c, const Frame& frame, const SpotCone& cone,
                           std::span<const SpotCone> cones, Rng& rng, HemisphereEstimate& sum) const {
    const Frame around(cone.axis);
    const double shift0 = rng.next(), shift1 = rng.next(), share = cone.solid_angle() / cone.rays;
    double sum1 = 0, sum2 = 0;
    for (int i = 0; i < cone.rays; ++i) {
        const Vec3 w = around.to_world(
            uniform_cone(kronecker(shift0, i, kR2[0]), kronecker(shift1, i, kR2[1]), cone.cos_half_angle));
        const float z = w.dot(frame.n);
        if (!(z > 0) || !c.leaves(w)) continue;
        const auto arrival = rays_.trace(c.vertex, w, z * kInvPi, kSeenStraight, rng);
        if (spot_of(c.vertex.point.p + w * arrival.distance, cones) != &cone) continue;
        const Rgb brought = arrival.indirect * (share * c.vertex.bsdf.diffuse_weight(w));
        sum.irradiance += brought * static_cast<double>(z);
        const double y = luminance(brought) * static_cast<double>(z);
        add(sum.reaching, arrival, y);
        sum1 += y;
        sum2 += y * y;
        const Vec3 tangent = w - frame.n * z;
        for (int k = 0; k < 3; ++k) {
            const auto radiance = static_cast<float>(brought[k]);
            sum.rotation[static_cast<std::size_t>(k)] += tangent * radiance;
            // A small patch that turns its face this way brings cos / r^2 of its light.
            sum.translation[static_cast<std::size_t>(k)] += tangent * (3 * radiance * z / arrival.distance);
        }
    }
    sum.variance += sum2 - sum1 * sum1 / cone.rays;
}

} // namespace keyhole
