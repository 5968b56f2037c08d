#include "photonmap/surface/box_tree.h"

#include <algorithm>
#include <numeric>

namespace keyhole {

BoxTree::BoxTree(const std::vector<Bounds>& boxes) : items_(boxes.size()) {
    if (boxes.empty()) return;
    std::iota(items_.begin(), items_.end(), 0u);
    nodes_.emplace_back();
    build(boxes, 0, 0, static_cast<std::uint32_t>(boxes.size()));
}

void BoxTree::build(const std::vector<Bounds>& boxes, std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    const auto centre = [&](std::uint32_t i) { return boxes[i].lower + boxes[i].upper; };
    Bounds bounds = boxes[items_[begin]];
    Bounds centres{centre(items_[begin]), centre(items_[begin])};
    for (std::uint32_t i = begin + 1; i < end; ++i) {
        bounds.extend(boxes[items_[i]]);
        centres.extend({centre(items_[i]), centre(items_[i])});
    }
    if (end - begin <= kLeafSize) {
        nodes_[node] = {bounds, begin, end - begin};
        return;
    }
    const Vec3 extent = centres.upper - centres.lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const float ca = centre(a)[axis], cb = centre(b)[axis];
                         return ca != cb ? ca < cb : a < b;
                     });
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[node] = {bounds, children, 0};
    build(boxes, children, begin, middle);
    build(boxes, children + 1, middle, end);
}

} // namespace keyhole
