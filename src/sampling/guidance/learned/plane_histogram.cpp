#include "sampling/guidance/learned/plane_histogram.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace keyhole {
namespace {

constexpr std::size_t kPointsOfLeaf = 8;
constexpr int kMostDepth = 12;
/// Of a node's share, what is divided by area.
constexpr double kEven = 0.1;
/// Of all samples, those that are spread evenly over the bounding box and so much of its width on each side of it.
constexpr double kEvenly = 0.15, kAround = 0.2;

double weight_of(std::span<const PlaneHistogram::Point> points) {
    return std::accumulate(points.begin(), points.end(), 0.0,
                           [](double sum, const PlaneHistogram::Point& p) { return sum + p.weight; });
}

} // namespace

PlaneHistogram::PlaneHistogram(std::span<Point> points, const Box& limits) {
    const double infinity = std::numeric_limits<double>::infinity();
    box_ = {{infinity, infinity}, {-infinity, -infinity}};
    for (const Point& p : points)
        for (int k = 0; k < 2; ++k) {
            box_.lower[k] = std::min(box_.lower[k], p.x[k]);
            box_.upper[k] = std::max(box_.upper[k], p.x[k]);
        }
    if (points.size() < 2 || !(box_.area() > 0) || !(weight_of(points) > 0)) return;
    for (int k = 0; k < 2; ++k) {
        const double more = kAround * (box_.upper[k] - box_.lower[k]);
        around_.lower[k] = std::max(box_.lower[k] - more, limits.lower[k]);
        around_.upper[k] = std::min(box_.upper[k] + more, limits.upper[k]);
    }
    build(points, box_, 0);
}

void PlaneHistogram::build(std::span<Point> points, const Box& box, int depth) {
    const std::size_t self = nodes_.size();
    nodes_.emplace_back();
    if (points.size() < 2 * kPointsOfLeaf || depth == kMostDepth) return;
    const int axis = box.upper[1] - box.lower[1] > box.upper[0] - box.lower[0] ? 1 : 0;
    const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
    std::ranges::nth_element(points, middle, {}, [&](const Point& p) { return p.x[axis]; });
    const double split = middle->x[axis];
    if (!(split > box.lower[axis] && split < box.upper[axis])) return;
    Box left = box, right = box;
    left.upper[axis] = right.lower[axis] = split;
    const auto lower = points.first(points.size() / 2), upper = points.subspan(points.size() / 2);
    const double below = weight_of(lower), all = below + weight_of(upper), by_area = left.area() / box.area();
    nodes_[self].left_share = (1 - kEven) * (all > 0 ? below / all : by_area) + kEven * by_area;
    nodes_[self].split = split;
    nodes_[self].axis = static_cast<std::uint8_t>(axis);
    build(lower, left, depth + 1);
    nodes_[self].right = static_cast<std::uint32_t>(nodes_.size());
    build(upper, right, depth + 1);
}

PlaneHistogram::Place PlaneHistogram::sample(double u0, double u1) const {
    if (u0 >= kEvenly) return sample_tree((u0 - kEvenly) / (1 - kEvenly), u1);
    const auto along = [&](int k, double u) { return around_.lower[k] + u * (around_.upper[k] - around_.lower[k]); };
    return {{along(0, u0 / kEvenly), along(1, u1)}};
}

double PlaneHistogram::pdf(const Place& place) const {
    for (int k = 0; k < 2; ++k)
        if (!(place.x[k] >= around_.lower[k] && place.x[k] <= around_.upper[k])) return 0;
    return kEvenly / around_.area() + (1 - kEvenly) * tree_pdf(place);
}

PlaneHistogram::Place PlaneHistogram::sample_tree(double u0, double u1) const {
    Box box = box_;
    std::uint32_t i = 0;
    while (nodes_[i].right != 0) {
        const Node& n = nodes_[i];
        const bool left = u0 < n.left_share;
        u0 = left ? u0 / n.left_share : (u0 - n.left_share) / (1 - n.left_share);
        (left ? box.upper : box.lower)[n.axis] = n.split;
        i = left ? i + 1 : n.right;
    }
    return {{box.lower[0] + u0 * (box.upper[0] - box.lower[0]), box.lower[1] + u1 * (box.upper[1] - box.lower[1])}};
}

double PlaneHistogram::tree_pdf(const Place& place) const {
    for (int k = 0; k < 2; ++k)
        if (place.x[k] < box_.lower[k] || place.x[k] > box_.upper[k]) return 0;
    Box box = box_;
    double share = 1;
    std::uint32_t i = 0;
    while (nodes_[i].right != 0) {
        const Node& n = nodes_[i];
        const bool left = place.x[n.axis] < n.split;
        share *= left ? n.left_share : 1 - n.left_share;
        (left ? box.upper : box.lower)[n.axis] = n.split;
        i = left ? i + 1 : n.right;
    }
    return share / box.area();
}

} // namespace keyhole
