#include "sampling/guidance/learned/emission_targets.h"

#include "scene/warp.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace keyhole {
namespace {

/// Targets of a cell, at least: histograms of directions need many.
constexpr std::size_t kLeastTargets = 384;
/// A target's ball reaches to its neighbour of this number in the cell.
constexpr std::size_t kNeighbour = 6;
/// Of the light of a cell's targets, what goes to a ball around them all: between their balls are gaps.
constexpr double kAroundAll = 0.1;
/// Of directions towards an environment, those that go by its own light: some that matter were never found.
constexpr double kOwn = 0.1;
/// Radius of a ball, at least, over that of the scene.
constexpr float kLeastRadius = 1e-5f;

/// Distance to the neighbour that a target's ball reaches to.
float radius_of(const SeenLight& target, std::span<const SeenLight* const> cell, std::vector<float>& squares) {
    squares.clear();
    for (const SeenLight* other : cell) squares.push_back((other->at.p - target.at.p).length2());
    const std::size_t k = std::min(kNeighbour, squares.size() - 1);
    std::ranges::nth_element(squares, squares.begin() + static_cast<std::ptrdiff_t>(k));
    return std::sqrt(squares[k]);
}

/// Of the cone in which a ball is seen from a distance, 1 - cosine of half its angle; 2, all directions, from within.
double cone_of(double radius, double distance) {
    if (!(radius < distance)) return 2;
    const double sine2 = radius * radius / (distance * distance);
    return sine2 / (1 + std::sqrt(1 - sine2));
}

/// A direction in that cone.
Vec3 into_ball(const Ball& ball, const Vec3& from, SampleSource& source) {
    const Vec3 to = ball.center - from;
    const double distance = Imath::V3d(to).length();
    const Frame frame(distance > 0 ? to.normalized() : Vec3(0, 0, 1));
    const auto [u0, u1] = source.take<2>();
    return frame.to_world(uniform_cone(u0, u1, 1 - cone_of(ball.radius, distance))).normalized();
}

/// A point of the disc that cuts the ball in half across `n`.
Vec3 on_disc(const Ball& ball, const Vec3& n, SampleSource& source) {
    const auto [u0, u1] = source.take<2>();
    const Vec2 d = uniform_disc(u0, u1) * ball.radius;
    return ball.center + Frame(n).to_world(Vec3(d.x, d.y, 0));
}

} // namespace

EmitterRay parallel_ray(const Scene& scene, const SurfacePoint& x0, const Vec3& p) {
    const BoundingSphere bounds = scene.bounding_sphere();
    EmitterRay ray;
    ray.w = x0.ng;
    ray.origin.site = Site::point;
    ray.origin.p = p - ray.w * ((p - bounds.center).dot(ray.w) + bounds.radius);
    return ray;
}

EmissionTargets::EmissionTargets(const Scene& scene, std::span<const SeenLight> seen) : scene_(&scene) {
    if (seen.empty()) return;
    SeenInCells by_cell(seen, kLeastTargets);
    std::vector<Ball> balls;
    std::vector<double> weights;
    for (auto& here : by_cell.cells) {
        std::ranges::stable_sort(here, {}, &SeenLight::emitter);
        add_cell(here, balls, weights);
    }
    choice_ = EmitterDistribution(weights);
    std::vector<std::uint32_t> emitters; // a line of light may have been drawn towards its emitter's targets only
    emitters.reserve(balls.size());
    for (const std::uint32_t group : group_of_) emitters.push_back(groups_[group].emitter);
    targets_ = BallTree(std::move(balls), emitters);
}

/// `seen`: sorted by emitter.
void EmissionTargets::add_cell(std::span<const SeenLight* const> seen, std::vector<Ball>& balls,
                               std::vector<double>& weights) {
    const float least = kLeastRadius * scene_->bounding_sphere().radius;
    std::vector<float> squares;
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
        const std::uint32_t emitter = seen[begin]->emitter;
        const bool environment = is_environment(scene_->emitter(emitter));
        std::vector<DirectionHistogram::Ray> rays;
        const auto add = [&](const Ball& ball, double weight) {
            balls.push_back(ball);
            weights.push_back(weight);
            group_of_.push_back(static_cast<std::uint32_t>(groups_.size()));
        };
        double weight = 0;
        for (; end < seen.size() && seen[end]->emitter == emitter; ++end) {
            const SeenLight& s = *seen[end];
            add({s.at.p, std::max(radius_of(s, seen, squares), least)}, (1 - kAroundAll) * s.weight);
            if (environment) rays.push_back({s.at.p, s.towards, s.weight});
            weight += s.weight;
        }
        add(ball_around(std::span(balls).last(end - begin)), kAroundAll * weight);
        DirectionHistogram directions;
        if (!rays.empty()) directions = DirectionHistogram(rays, DirectionHistogram::meeting_plane(rays));
        groups_.push_back({emitter, std::move(directions)});
    }
}

FirstEdge EmissionTargets::sample(double u, SampleSource& source) const {
    const std::uint32_t i = choice_.sample(u);
    const Group& group = groups_[group_of_[i]];
    const Ball& target = targets_.balls()[i];
    FirstEdge edge;
    auto& [x0, ray] = edge;
    if (group.directions.empty()) {
        x0 = scene_->emitter(group.emitter).sample_point(source).point;
        if (x0.site == Site::infinite) {
            ray = parallel_ray(*scene_, x0, on_disc(target, x0.ng, source));
        } else {
            ray.w = into_ball(target, x0.p, source);
            ray.origin = x0;
        }
    } else {
        const double v = source.next();
        const auto [u0, u1] = source.take<2>();
        if (v >= 1 - kOwn) {
            x0 = scene_->emitter(group.emitter).sample_point(source).point;
            ray = parallel_ray(*scene_, x0, on_disc(target, x0.ng, source));
        } else if (v < (1 - kOwn) * group.map_share()) {
            x0 = infinite_point(group.directions.sample_on_map(u0, u1));
            ray = parallel_ray(*scene_, x0, on_disc(target, x0.ng, source));
        } else {
            const Vec3 q = group.directions.sample_on_plane(u0, u1);
            x0 = infinite_point(-into_ball(target, q, source));
            ray = parallel_ray(*scene_, x0, q);
        }
    }
    x0.emitter = group.emitter;
    return edge;
}

double EmissionTargets::pdf(const FirstEdge& edge) const {
    const auto& [x0, ray] = edge;
    const Vec3& w = ray.w;
    const double own = scene_->emitter(x0.emitter).point_pdf(x0);
    DirectionHistogram::Place on_map{};
    if (x0.site == Site::infinite) on_map = DirectionHistogram::place_on_map(-w);
    const Group* last = nullptr; // targets of a group follow each other
    Ways ways;
    double sum = 0;
    for (const std::uint32_t i : targets_.along(ray.origin.p, w, x0.emitter)) {
        const Group& group = groups_[group_of_[i]];
        if (std::exchange(last, &group) != &group) ways = group.ways(x0, ray, own, on_map);
        sum += choice_.probability(i) * ways.pdf(targets_.balls()[i], w);
    }
    return sum;
}

EmissionTargets::Ways EmissionTargets::Group::ways(const SurfacePoint& x0, const EmitterRay& ray, double own,
                                                   const DirectionHistogram::Place& on_map) const {
    if (x0.site != Site::infinite) return {.from = x0.p, .from_pdf = own};
    if (directions.empty()) return {.parallel = own};
    Ways ways{.parallel = (1 - kOwn) * map_share() * directions.pdf_on_map(on_map) + kOwn * own};
    if (!directions.has_plane()) return ways;
    if (const auto on = directions.on_plane(ray.origin.p, ray.w)) {
        ways.from = on->q;
        ways.from_pdf = (1 - kOwn) * (1 - map_share()) * on->pdf;
    }
    return ways;
}

double EmissionTargets::Ways::pdf(const Ball& target, const Vec3& w) const {
    const double radius = target.radius;
    double sum = parallel * kInvPi / (radius * radius);
    if (from_pdf > 0 && passes(target, from, w))
        sum += from_pdf / (2 * kPi * cone_of(radius, (Imath::V3d(target.center) - Imath::V3d(from)).length()));
    return sum;
}

std::size_t EmissionTargets::bytes() const {
    std::size_t sum = targets_.bytes() + group_of_.capacity() * (sizeof(std::uint32_t) + sizeof(double)) +
                      groups_.capacity() * sizeof(Group);
    for (const Group& group : groups_) sum += group.directions.bytes();
    return sum;
}

} // namespace keyhole
