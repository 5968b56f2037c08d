#include "photonmap/kd_tree.h"

#include <nanoflann.hpp>

namespace keyhole {
namespace {

/// The interface that nanoflann reads points through.
struct Points {
    std::span<const Photon> photons;

    std::size_t kdtree_get_point_count() const { return photons.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return photons[i].position()[static_cast<int>(axis)]; }
    template <class Box> bool kdtree_get_bbox(Box& /*box*/) const { return false; }
};

using Built = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points, float, std::uint32_t>,
                                                  Points, 3, std::uint32_t>;

/// Brings photons into the order of the tree's leaves, in place: following the cycles of the permutation, since a
/// second array would double the memory of a map.
void permute(std::span<Photon> photons, std::vector<std::uint32_t>& order) {
    for (std::uint32_t start = 0; start < order.size(); ++start) {
        if (order[start] == start) continue;
        const Photon first = photons[start];
        std::uint32_t to = start;
        while (order[to] != start) {
            const std::uint32_t from = order[to];
            photons[to] = photons[from];
            order[to] = to;
            to = from;
        }
        photons[to] = first;
        order[to] = to;
    }
}

std::size_t count_nodes(const Built::Node& node) {
    return node.child1 == nullptr ? 1 : 1 + count_nodes(*node.child1) + count_nodes(*node.child2);
}

} // namespace

KdTree::KdTree(std::span<Photon> photons, std::uint32_t begin, std::uint32_t end, std::uint32_t leaf) {
    if (begin == end) return;
    const Points own{photons.subspan(begin, end - begin)};
    Built built(3, own, nanoflann::KDTreeSingleIndexAdaptorParams(leaf));
    permute(photons.subspan(begin, end - begin), built.vAcc);
    nodes_.reserve(count_nodes(*built.root_node));
    append(*built.root_node, begin);
    for (int k = 0; k < 3; ++k) {
        const auto& side = built.root_bbox[static_cast<std::size_t>(k)];
        lower_[k] = side.low;
        upper_[k] = side.high;
    }
}

template <class BuiltNode> void KdTree::append(const BuiltNode& node, std::uint32_t begin) {
    if (node.child1 == nullptr) {
        const auto& range = node.node_type.lr;
        nodes_.push_back(Node::leaf(begin + static_cast<std::uint32_t>(range.left),
                                    begin + static_cast<std::uint32_t>(range.right)));
        return;
    }
    const auto& split = node.node_type.sub;
    const std::size_t here = nodes_.size();
    nodes_.push_back(Node::inner(static_cast<std::uint32_t>(split.divfeat), split.divlow, split.divhigh));
    append(*node.child1, begin);
    nodes_[here].set_upper(static_cast<std::uint32_t>(nodes_.size()));
    append(*node.child2, begin);
}

} // namespace keyhole
