#include "sampling/guidance/learned/surface_cells.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <array>

namespace keyhole {
namespace {

/// Opposite normals are as far apart as places this far in the scene, as a share of its extent.
constexpr float kNormals = 0.2f;

} // namespace

SurfaceCells::SurfaceCells(std::vector<Place> points, std::size_t least) {
    if (points.empty()) return;
    Imath::Box3f box;
    for (const Place& place : points) box.extendBy(place.p);
    normal_scale_ = kNormals / 2 * box.size().length();
    nodes_.clear();
    cells_ = 0;
    build(points, std::max<std::size_t>(least, 1));
}

void SurfaceCells::build(std::span<Place> points, std::size_t least) {
    const std::size_t self = nodes_.size();
    nodes_.emplace_back();
    Node node;
    std::size_t left = 0;
    if (points.size() < 2 * least || !split(points, least, node, left)) {
        nodes_[self].right = cells_++;
        return;
    }
    build(points.first(left), least);
    node.right = static_cast<std::uint32_t>(nodes_.size());
    nodes_[self] = node;
    build(points.subspan(left), least);
}

/// Along the widest extent that leaves enough points on both sides; their order is that of the sides afterwards.
bool SurfaceCells::split(std::span<Place> points, std::size_t least, Node& node, std::size_t& left) const {
    struct Extent {
        float width;
        int axis;
    };
    std::array<Extent, kDimensions> extents{};
    for (int axis = 0; axis < kDimensions; ++axis) {
        const auto at = [&](const Place& place) { return coordinate(place, axis); };
        const auto [low, high] = std::ranges::minmax(points, {}, at);
        extents[static_cast<std::size_t>(axis)] = {at(high) - at(low), axis};
    }
    std::ranges::stable_sort(extents, std::greater{}, &Extent::width);
    for (const Extent& extent : extents) {
        if (!(extent.width > 0)) return false;
        const auto at = [&](const Place& place) { return coordinate(place, extent.axis); };
        const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
        std::ranges::nth_element(points, middle, {}, at);
        node.split = at(*middle);
        node.axis = static_cast<std::int8_t>(extent.axis);
        const auto right =
            std::partition(points.begin(), points.end(), [&](const Place& place) { return at(place) < node.split; });
        left = static_cast<std::size_t>(right - points.begin());
        if (left >= least && points.size() - left >= least) return true;
    }
    return false;
}

std::uint32_t SurfaceCells::cell_of(const Place& place) const {
    std::uint32_t i = 0;
    while (nodes_[i].axis >= 0) i = coordinate(place, nodes_[i].axis) < nodes_[i].split ? i + 1 : nodes_[i].right;
    return nodes_[i].right;
}

} // namespace keyhole
