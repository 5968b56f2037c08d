#include "photonmap/surface/box_tree.h"

#include <algorithm>
#include <numeric>

namespace keyhole {

BoxTree::BoxTree(const std::vector<Imath::Box3f>& boxes) : items_(boxes.size()) {
    if (boxes.empty()) return;
    std::iota(items_.begin(), items_.end(), 0u);
    nodes_.emplace_back();
    build(boxes, 0, 0, static_cast<std::uint32_t>(boxes.size()));
}

void BoxTree::build(const std::vector<Imath::Box3f>& boxes, std::uint32_t node, std::uint32_t begin,
                    std::uint32_t end) {
    const auto centre = [&](std::uint32_t i) { return boxes[i].min + boxes[i].max; };
    Imath::Box3f bounds, centres;
    for (std::uint32_t i = begin; i < end; ++i) {
        bounds.extendBy(boxes[items_[i]]);
        centres.extendBy(centre(items_[i]));
    }
    if (end - begin <= kLeafSize) {
        nodes_[node] = {bounds, begin, end - begin};
        return;
    }
    const auto axis = static_cast<int>(centres.majorAxis());
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
