#include "sampling/guidance/learned/direction_histogram.h"

#include "scene/emitters/sphere_map.h"

#include <Imath/ImathBoxAlgo.h>
#include <Imath/ImathMatrix.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace keyhole {
namespace {

constexpr std::size_t kPointsOfLeaf = 12;
/// Of the map of directions behind a plane, which only tells of those that are flat to it.
constexpr std::size_t kPointsOfCoarseLeaf = 48;
/// Width of a node's box beyond its points over that of where it may lie, at least.
constexpr double kThinnest = 0.01;
/// Of a node's share, what is spread over all of its box.
constexpr float kEven = 0.05f;
/// Of all samples, those that are spread evenly over the bounding box and so much of its width on each side of it.
constexpr double kEvenly = 0.15, kAround = 0.2;

double area(const Imath::Box2d& box) {
    const Imath::V2d size = box.size();
    return size.x * size.y;
}

double weight_of(std::span<const PlaneHistogram::Point> points) {
    return std::accumulate(points.begin(), points.end(), 0.0,
                           [](double sum, const PlaneHistogram::Point& p) { return sum + p.weight; });
}

/// `box` with `more` on either side, but within `limits`.
Imath::Box2d widened(const Imath::Box2d& box, const Imath::V2d& more, const Imath::Box2d& limits) {
    Imath::Box2d wide;
    for (int k = 0; k < 2; ++k) {
        wide.min[k] = std::max(box.min[k] - more[k], limits.min[k]);
        wide.max[k] = std::min(box.max[k] + more[k], limits.max[k]);
    }
    return wide;
}

Imath::Box2d bounds_of(std::span<const PlaneHistogram::Point> points) {
    Imath::Box2d box;
    for (const PlaneHistogram::Point& p : points) box.extendBy(p.x);
    return box;
}

/// Around points that lie within `limits`: evenly spread ones end short of where they may lie by their mean distance.
Imath::Box2d box_around(std::span<const PlaneHistogram::Point> points, const Imath::Box2d& limits) {
    const Imath::Box2d box = bounds_of(points);
    Imath::V2d more;
    for (int k = 0; k < 2; ++k)
        more[k] = std::max(box.size()[k] / static_cast<double>(points.size() - 1), kThinnest * limits.size()[k]);
    const Imath::Box2d wide = widened(box, more, limits);
    return area(wide) > 0 ? wide : limits;
}

/// Fewer rays than this on either half tell nothing of where they meet.
constexpr std::size_t kLeastRays = 16;
/// Rays to a plane may be as flat as this [cosine]: others are not counted on it.
constexpr double kFlattest = 0.05;
/// A place as near to the plane as this doesn't use it: height over distance from its middle.
constexpr float kNearest = 1e-3f;
/// Between the mean direction and the normal of a window.
constexpr float kLeastCosine = 0.25f;
/// Rays seem to meet before the window, the more the farther apart they begin: how much farther it may be.
constexpr float kFarther[] = {1.15f, 1.3f, 1.5f, 1.8f};
/// Of the octahedral map, per solid angle.
constexpr double kDensityOfOctahedron = kInvPi / 4;

/// Where the line through `p` along `w` meets a plane: there, there in the plane's frame, and how far along the line.
struct Crossing {
    Vec3 q, local;
    double along;
};

std::optional<Crossing> crossing(const Vec3& center, const Frame& frame, const Vec3& p, const Vec3& w) {
    const double along = static_cast<double>((center - p).dot(frame.n)) / w.dot(frame.n);
    if (!std::isfinite(along)) return std::nullopt;
    const Vec3 q = p + w * static_cast<float>(along);
    return Crossing{q, frame.to_local(q - center), along};
}

/// Of planes that windows may lie in: across the mean direction, and upright or level as the scene's axes are.
std::vector<Vec3> likely_normals(std::span<const DirectionHistogram::Ray> rays) {
    Vec3 mean(0, 0, 0);
    for (const auto& ray : rays) mean += ray.w;
    if (!(mean.length() > 0)) return {};
    mean.normalize();
    std::vector<Vec3> normals{mean};
    for (int k = 0; k < 3; ++k) {
        Vec3 axis(0, 0, 0);
        axis[k] = mean[k] < 0 ? -1.0f : 1.0f;
        if (axis.dot(mean) > kLeastCosine) normals.push_back(axis);
    }
    return normals;
}

} // namespace

PlaneHistogram::PlaneHistogram(std::span<Point> points, std::size_t leaf, const Imath::Box2d& limits) {
    const Imath::Box2d box = bounds_of(points);
    if (points.size() < 2 || !(area(box) > 0) || !(weight_of(points) > 0)) return;
    around_ = widened(box, kAround * box.size(), limits);
    build(points, box, leaf);
}

void PlaneHistogram::build(std::span<Point> points, const Imath::Box2d& box, std::size_t leaf) {
    const std::size_t self = nodes_.size();
    nodes_.push_back({.box = {Imath::V2f(box.min), Imath::V2f(box.max)}, .density = static_cast<float>(1 / area(box))});
    if (points.size() < 2 * leaf) return;
    const int axis = box.size().y > box.size().x ? 1 : 0;
    const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
    std::ranges::nth_element(points, middle, {}, [&](const Point& p) { return p.x[axis]; });
    const double split = middle->x[axis];
    if (!(split > box.min[axis] && split < box.max[axis])) return;
    Imath::Box2d left = box, right = box;
    left.max[axis] = right.min[axis] = split;
    const auto lower = points.first(points.size() / 2), upper = points.subspan(points.size() / 2);
    const double below = weight_of(lower), all = below + weight_of(upper);
    nodes_[self].density *= kEven;
    nodes_[self].left_share = all > 0 ? static_cast<float>(below / all) : 0.5f;
    nodes_[self].split = static_cast<float>(split);
    nodes_[self].axis = static_cast<unsigned>(axis) & 1U;
    build(lower, box_around(lower, left), leaf);
    nodes_[self].right = static_cast<std::uint32_t>(nodes_.size()) & 0x7FFFFFFFU;
    build(upper, box_around(upper, right), leaf);
}

PlaneHistogram::Place PlaneHistogram::sample(double u0, double u1) const {
    if (u0 >= kEvenly) return sample_tree((u0 - kEvenly) / (1 - kEvenly), u1);
    return around_.min + Place(u0 / kEvenly, u1) * around_.size();
}

double PlaneHistogram::pdf(const Place& place) const {
    if (Imath::clip(place, around_) != place) return 0; // also where it is no number
    return kEvenly / area(around_) + (1 - kEvenly) * tree_pdf(place);
}

PlaneHistogram::Place PlaneHistogram::sample_tree(double u0, double u1) const {
    std::uint32_t i = 0;
    while (nodes_[i].right != 0) {
        const Node& n = nodes_[i];
        if (u0 < kEven) {
            u0 /= kEven;
            break;
        }
        u0 = (u0 - kEven) / (1 - kEven);
        const bool left = u0 < n.left_share;
        u0 = left ? u0 / n.left_share : (u0 - n.left_share) / (1 - n.left_share);
        i = left ? i + 1 : n.right;
    }
    const Imath::Box2f& box = nodes_[i].box;
    return Place(box.min) + Place(u0, u1) * Place(box.size());
}

double PlaneHistogram::tree_pdf(const Place& place) const {
    const Imath::V2f x(place);
    float sum = 0, share = 1;
    std::uint32_t i = 0;
    while (nodes_[i].box.intersects(x)) {
        const Node& n = nodes_[i];
        sum += share * n.density;
        if (n.right == 0) break;
        const bool left = x[n.axis] < n.split;
        share *= (1 - kEven) * (left ? n.left_share : 1 - n.left_share);
        i = left ? i + 1 : n.right;
    }
    return sum;
}

DirectionHistogram::DirectionHistogram(std::span<const Ray> rays, const std::optional<Plane>& plane) : plane_(plane) {
    if (plane_) frame_ = Frame(plane_->n);
    std::vector<PlaneHistogram::Point> on_map, points;
    for (const Ray& ray : rays) {
        on_map.push_back({place_on_map(ray.w), ray.weight});
        if (!plane_) continue;
        if (!(std::abs(ray.w.dot(frame_.n)) > kFlattest)) continue;
        if (const auto at = crossing(plane_->center, frame_, ray.p, ray.w); at && at->along > 0)
            points.push_back({{at->local.x, at->local.y}, ray.weight});
    }
    if (plane_) histogram_ = PlaneHistogram(points, kPointsOfLeaf);
    octahedral_ = PlaneHistogram(on_map, has_plane() ? kPointsOfCoarseLeaf : kPointsOfLeaf, {{0, 0}, {1, 1}});
}

std::optional<Vec3> DirectionHistogram::meeting_point(std::span<const Ray> rays) {
    Imath::M33d a(0.0);
    Imath::V3d b(0.0);
    for (const Ray& ray : rays) {
        const Imath::V3d w(ray.w), p(ray.p);
        const Imath::V3d across = p - w * w.dot(p);
        for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k) a[i][k] += (i == k ? 1.0 : 0.0) - w[i] * w[k];
            b[i] += across[i];
        }
    }
    const double n = static_cast<double>(rays.size());
    if (!(a.determinant() > 1e-9 * n * n * n)) return std::nullopt; // parallel
    const Imath::V3d x = b * a.inverse();                           // a is symmetric
    if (!std::isfinite(x.length2())) return std::nullopt;
    return Vec3(x);
}

std::optional<DirectionHistogram::Plane> DirectionHistogram::meeting_plane(std::span<const Ray> rays) {
    const auto [some, others] = halves_of(rays);
    if (others.size() < kLeastRays) return std::nullopt;
    const auto meeting = meeting_point(some);
    if (!meeting) return std::nullopt;
    const auto likelihood_of = [&some = some, &others = others](const std::optional<Plane>& plane) {
        const DirectionHistogram histogram(some, plane);
        return log_likelihood(
            others, [&](const Vec3& p, const Vec3& w) { return histogram.empty() ? 0 : histogram.pdf(p, w); });
    };
    std::optional<Plane> best;
    double best_likelihood = likelihood_of(best);
    const auto consider = [&](const Plane& plane) {
        const double likelihood = likelihood_of(plane);
        if (!(likelihood > best_likelihood)) return;
        best_likelihood = likelihood;
        best = plane;
    };
    for (const Vec3& n : likely_normals(some)) consider({*meeting, n});
    if (!best) return best;
    Imath::V3d from(0.0);
    for (const Ray& ray : rays) from += Imath::V3d(ray.p) / static_cast<double>(rays.size());
    const Plane near = *best;
    for (const float factor : kFarther) consider({Vec3(from) + (near.center - Vec3(from)) * factor, near.n});
    return best;
}

double DirectionHistogram::share_of_octahedron(const Vec3& p) const {
    if (histogram_.empty()) return 1;
    // From within the plane all its points lie in directions that floats can't tell from those beside it.
    return std::abs((plane_->center - p).dot(frame_.n)) > kNearest * (plane_->center - p).length() ? kNotOnPlane : 1;
}

Vec3 DirectionHistogram::sample_on_plane(double u0, double u1) const {
    const PlaneHistogram::Place place = histogram_.sample(u0, u1);
    return plane_->center + frame_.to_world(Vec3(static_cast<float>(place.x), static_cast<float>(place.y), 0));
}

std::optional<DirectionHistogram::OnPlane> DirectionHistogram::on_plane(const Vec3& p, const Vec3& w) const {
    const auto at = crossing(plane_->center, frame_, p, w);
    if (!at) return std::nullopt;
    return OnPlane{at->q, histogram_.pdf({at->local.x, at->local.y}) / std::abs(w.dot(frame_.n))};
}

Vec3 DirectionHistogram::sample_on_map(double u0, double u1) const {
    return sphere_direction(SphereLayout::octahedral, octahedral_.sample(u0, u1));
}

DirectionHistogram::Place DirectionHistogram::place_on_map(const Vec3& w) {
    return sphere_place(SphereLayout::octahedral, w);
}

double DirectionHistogram::pdf_on_map(const Place& place) const {
    return kDensityOfOctahedron * octahedral_.pdf(place);
}

Vec3 DirectionHistogram::sample(const Vec3& p, double u0, double u1) const {
    const double flat = share_of_octahedron(p);
    if (u0 < flat) return sample_on_map(u0 / flat, u1);
    return (sample_on_plane((u0 - flat) / (1 - flat), u1) - p).normalized();
}

double DirectionHistogram::pdf(const Vec3& p, const Vec3& w, const Place& on_map) const {
    const double flat = share_of_octahedron(p);
    double sum = flat * pdf_on_map(on_map);
    if (flat == 1) return sum;
    const auto on = on_plane(p, w);
    if (!on || !((on->q - p).dot(w) > 0)) return sum; // behind p
    return sum + (1 - flat) * on->pdf * static_cast<double>((on->q - p).length2());
}

} // namespace keyhole
