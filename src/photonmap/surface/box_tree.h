// A tree of bounding boxes, world space, that finds those which overlap a given box.
#pragma once

#include <Imath/ImathBox.h>

#include <cstdint>
#include <vector>

namespace keyhole {

/// Bounding volume hierarchy split at medians. Immutable and thread-safe; visits in an order that depends on the boxes
/// alone.
class BoxTree {
  public:
    explicit BoxTree(const std::vector<Imath::Box3f>& boxes);

    /// Calls visit(i) for every box i that may overlap `region`, until one call returns false; then this does, too. It
    /// comes close, but the leaves aren't tested one by one.
    template <class Visit> bool overlapping(const Imath::Box3f& region, Visit&& visit) const {
        if (nodes_.empty()) return true;
        std::uint32_t stack[kMaxDepth];
        int top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[stack[--top]];
            if (!node.bounds.intersects(region)) continue;
            if (node.count > 0) {
                for (std::uint32_t i = 0; i < node.count; ++i)
                    if (!visit(items_[node.first + i])) return false;
            } else {
                stack[top++] = node.first + 1;
                stack[top++] = node.first;
            }
        }
        return true;
    }

  private:
    static constexpr int kMaxDepth = 64; // medians halve: 2^32 boxes need 32 levels
    static constexpr std::uint32_t kLeafSize = 2;

    struct Node {
        Imath::Box3f bounds;
        std::uint32_t first; ///< of its items, or of its two children
        std::uint32_t count; ///< items; 0: an inner node
    };

    void build(const std::vector<Imath::Box3f>& boxes, std::uint32_t node, std::uint32_t begin, std::uint32_t end);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> items_;
};

} // namespace keyhole
