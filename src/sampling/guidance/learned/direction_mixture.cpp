#include "sampling/guidance/learned/direction_mixture.h"

#include <algorithm>

namespace keyhole {
namespace {

constexpr std::size_t kMostGroups = 4;
/// Rays for each group, at least.
constexpr std::size_t kRaysOfGroup = 32;
/// Of all directions, those that are shared out evenly among the groups: of a window behind which half of the rays
/// found nothing the other half may find much.
constexpr double kSharedOut = 0.1;
/// Rounds of k-means by direction, and then by place.
constexpr int kRounds = 2;

using Ray = DirectionMixture::Ray;
using Group = DirectionMixture::Group;

/// Cosine between a ray and the way to the aim of a group.
float towards(const Group& group, const Ray& ray) {
    return ray.w.dot(group.is_place ? (group.aim - ray.p).normalized() : group.aim);
}

std::size_t group_of(std::span<const Group> groups, const Ray& ray) {
    const auto best = std::ranges::max_element(groups, {}, [&](const Group& group) { return towards(group, ray); });
    return static_cast<std::size_t>(best - groups.begin());
}

std::vector<std::vector<Ray>> grouped(std::span<const Ray> rays, std::span<const Group> groups) {
    std::vector<std::vector<Ray>> by_group(groups.size());
    for (const Ray& ray : rays) by_group[group_of(groups, ray)].push_back(ray);
    return by_group;
}

Vec3 mean_direction(std::span<const Ray> rays) {
    Vec3 sum(0, 0, 0);
    for (const Ray& ray : rays) sum += ray.w;
    return sum.length() > 0 ? sum.normalized() : rays.front().w;
}

/// Directions that are far from each other: each ray in turn that is farthest from those before.
std::vector<Group> spread_out(std::span<const Ray> rays, std::size_t n) {
    std::vector<Group> groups{{mean_direction(rays)}};
    const auto nearest = [&](const Ray& ray) { return towards(groups[group_of(groups, ray)], ray); };
    groups[0].aim = std::ranges::min_element(rays, {}, nearest)->w;
    while (groups.size() < n) groups.push_back({std::ranges::min_element(rays, {}, nearest)->w});
    return groups;
}

/// What rays of a group lead towards: where they meet, if that is ahead of them.
Group aim_of(std::span<const Ray> rays) {
    const Vec3 mean = mean_direction(rays);
    const auto meeting = DirectionHistogram::meeting_point(rays);
    if (!meeting || std::ranges::any_of(rays, [&](const Ray& ray) { return (*meeting - ray.p).dot(mean) <= 0; }))
        return {mean};
    return {*meeting, true};
}

/// `n` groups at most, by k-means.
std::vector<Group> make_groups(std::span<const Ray> rays, std::size_t n) {
    std::vector<Group> groups = spread_out(rays, n);
    for (int round = 0; round < 2 * kRounds; ++round) {
        std::vector<Group> next;
        for (const auto& part : grouped(rays, groups))
            if (!part.empty()) next.push_back(round < kRounds ? Group{mean_direction(part)} : aim_of(part));
        groups = std::move(next);
    }
    const auto parts = grouped(rays, groups);
    for (std::size_t k = 0; k < groups.size(); ++k) {
        groups[k].plane = DirectionHistogram::meeting_plane(parts[k]);
        if (groups[k].plane) groups[k] = {groups[k].plane->center, true, groups[k].plane};
    }
    return groups;
}

double likelihood(const DirectionMixture& mixture, std::span<const Ray> rays) {
    return log_likelihood(rays, [&](const Vec3& p, const Vec3& w) {
        return mixture.empty() ? 0 : mixture.pdf(p, w, DirectionHistogram::place_on_map(w));
    });
}

} // namespace

std::vector<Group> DirectionMixture::groups_of(std::span<const Ray> rays) {
    std::vector<Group> best{{Vec3(0, 0, 1), false, DirectionHistogram::meeting_plane(rays)}};
    const auto [some, others] = halves_of(rays);
    double most = likelihood(DirectionMixture(some, best), others);
    for (std::size_t n = 2; n <= kMostGroups && n * kRaysOfGroup <= rays.size(); ++n) {
        std::vector<Group> groups = make_groups(rays, n);
        const double likely = likelihood(DirectionMixture(some, groups), others);
        if (!(likely > most)) break;
        most = likely;
        best = std::move(groups);
    }
    return best;
}

DirectionMixture::DirectionMixture(std::span<const Ray> rays, std::span<const Group> groups)
    : groups_(groups.begin(), groups.end()) {
    double sum = 0;
    const std::vector<std::vector<Ray>> by_group = grouped(rays, groups);
    for (std::size_t k = 0; k < groups.size(); ++k) {
        Part part{DirectionHistogram(by_group[k], groups[k].plane), 0};
        if (part.directions.empty()) continue;
        for (const Ray& ray : by_group[k]) part.share += ray.weight;
        sum += part.share;
        parts_.push_back(std::move(part));
    }
    for (Part& part : parts_)
        part.share = (1 - kSharedOut) * part.share / sum + kSharedOut / static_cast<double>(parts_.size());
}

Vec3 DirectionMixture::sample(const Vec3& p, double u0, double u1) const {
    for (const Part& part : parts_) {
        if (u0 < part.share || &part == &parts_.back())
            return part.directions.sample(p, std::min(u0 / part.share, 1 - 1e-16), u1);
        u0 -= part.share;
    }
    return Vec3(0, 0, 1);
}

double DirectionMixture::pdf(const Vec3& p, const Vec3& w, const DirectionHistogram::Place& on_map) const {
    double sum = 0;
    for (const Part& part : parts_) sum += part.share * part.directions.pdf(p, w, on_map);
    return sum;
}

std::size_t DirectionMixture::bytes() const {
    std::size_t sum = groups_.capacity() * sizeof(Group) + parts_.capacity() * sizeof(Part);
    for (const Part& part : parts_) sum += part.directions.bytes();
    return sum;
}

} // namespace keyhole
