// A kd-tree that takes little memory beside its photons.
#pragma once

#include "photonmap/photon.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace keyhole {

/// A tree that nanoflann builds, in a form of its own: photons lie in the order of its leaves, so that no list of
/// indices is needed, and nodes in the order of a walk, so that most need no pointer. Refers to no memory but its own.
/// Immutable and thread-safe once built; the same photons in the same order give the same tree.
class KdTree {
  public:
    KdTree() = default;
    /// Over photons [begin, end) of an array, which it puts in order. Leaves hold `leaf` photons at most.
    KdTree(std::span<Photon> photons, std::uint32_t begin, std::uint32_t end, std::uint32_t leaf);

    /// Calls result.offer(i), i an index of the array, for every photon whose squared distance to `p` is at most
    /// result.bound() [m^2] at that time, and for some that are farther; nearer leaves first.
    template <class Result> void search(const Vec3& p, Result& result) const {
        if (nodes_.empty()) return;
        const Vec3 below = lower_ - p, above = p - upper_;
        Vec3 outside;
        for (int k = 0; k < 3; ++k) outside[k] = std::max({below[k], above[k], 0.0f});
        if (!too_far(outside, result)) descend(0, outside, p, result);
    }

    /// Memory beside this [bytes].
    std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }
    /// About so much for each photon [bytes]: boxes are cut in the middle, and leaves half full.
    static constexpr double bytes_per_photon(std::uint32_t leaf) { return 2.0 * sizeof(Node) / (0.5 * leaf); }

  private:
    /// An inner node's lower child comes next. Photons of the lower child lie at most at `low` along the axis, those of
    /// the upper one at least at `high`.
    class Node {
      public:
        static Node inner(std::uint32_t axis, float low, float high) { return {low, high, axis}; }
        static Node leaf(std::uint32_t begin, std::uint32_t end) {
            return {std::bit_cast<float>(begin), std::bit_cast<float>(end), kLeaf};
        }
        void set_upper(std::uint32_t node) { link_ |= node << 2; }

        bool is_leaf() const { return link_ == kLeaf; }
        int axis() const { return static_cast<int>(link_ & 3); }
        std::uint32_t upper() const { return link_ >> 2; }
        float low() const { return low_; }
        float high() const { return high_; }
        std::uint32_t begin() const { return std::bit_cast<std::uint32_t>(low_); }
        std::uint32_t end() const { return std::bit_cast<std::uint32_t>(high_); }

      private:
        static constexpr std::uint32_t kLeaf = 3;

        Node(float low, float high, std::uint32_t link) : low_(low), high_(high), link_(link) {}

        float low_, high_;   ///< of a leaf, the bits of the indices of its photons
        std::uint32_t link_; ///< axis in two bits, and the upper child
    };

    template <class BuiltNode> void append(const BuiltNode& node, std::uint32_t begin);

    /// `outside`: how far the query lies from a node's box along each axis. Rounding must not hide what is just as far
    /// as the bound.
    template <class Result> static bool too_far(const Vec3& outside, const Result& result) {
        return outside.length2() * (1 - 1e-6f) > result.bound();
    }
    /// Distances are kept up to date along the way (Arya and Mount 1993).
    template <class Result> void descend(std::uint32_t at, Vec3 outside, const Vec3& p, Result& result) const {
        while (!nodes_[at].is_leaf()) {
            const Node& node = nodes_[at];
            const float x = p[node.axis()];
            const bool lower = (x - node.low()) + (x - node.high()) < 0;
            descend(lower ? at + 1 : node.upper(), outside, p, result);
            outside[node.axis()] = lower ? node.high() - x : x - node.low();
            if (too_far(outside, result)) return;
            at = lower ? node.upper() : at + 1;
        }
        for (std::uint32_t i = nodes_[at].begin(); i < nodes_[at].end(); ++i) result.offer(i);
    }

    std::vector<Node> nodes_;
    Vec3 lower_{0}, upper_{0}; ///< bounds of all
};

} // namespace keyhole
