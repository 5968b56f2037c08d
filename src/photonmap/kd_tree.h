// A kd-tree that takes next to no memory beside its photons.
#pragma once

#include "photonmap/photon.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace keyhole {

/// Splits photons at medians (Bentley 1975; balanced as in Jensen 2001, chapter 6, but with buckets): which photons a
/// node holds follows from its place in the tree, so that a node is a plane and nothing else. Photons lie in the order
/// of the leaves. Refers to no memory but its own. Immutable and thread-safe once built; the same photons in the same
/// order give the same tree.
class KdTree {
  public:
    KdTree() = default;
    /// Over photons [begin, end) of an array, which it puts in order. Leaves hold `leaf` photons at most, and at least
    /// half of that where there are so many.
    KdTree(std::span<Photon> photons, std::uint32_t begin, std::uint32_t end, std::uint32_t leaf);

    /// Calls result.offer(i), i an index of the array, for every photon whose squared distance to `p` is at most
    /// result.bound() [m^2] at that time, and for some that are farther; nearer leaves first.
    template <class Result> void search(const Vec3& p, Result& result) const {
        if (begin_ == end_) return;
        const Vec3 below = lower_ - p, above = p - upper_;
        Vec3 outside;
        for (int k = 0; k < 3; ++k) outside[k] = std::max({below[k], above[k], 0.0f});
        if (!too_far(outside, result)) descend({0, begin_, end_}, outside, p, result);
    }

    /// Memory beside this [bytes].
    std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }
    /// At most so much for each photon [bytes].
    static constexpr double bytes_per_photon(std::uint32_t leaf) { return 2.0 * sizeof(Node) / leaf; }

  private:
    /// An inner node: photons of its lower half are not above the plane, those of its upper half not below.
    struct Node {
        float plane;
        std::uint8_t axis;
    };
    /// Children of node n are 2 n + 1 and 2 n + 2; beyond the array they are leaves, all on one level.
    struct Place {
        std::size_t node;
        std::uint32_t begin, end;

        Place lower() const { return {2 * node + 1, begin, begin + (end - begin) / 2}; }
        Place upper() const { return {2 * node + 2, begin + (end - begin) / 2, end}; }
    };

    void build(std::span<Photon> photons, const Place& at);

    /// `outside`: how far the query lies from a node's box along each axis. Rounding must not hide what is just as far
    /// as the bound.
    template <class Result> static bool too_far(const Vec3& outside, const Result& result) {
        return outside.length2() * (1 - 1e-6f) > result.bound();
    }
    /// Distances are kept up to date along the way (Arya and Mount 1993).
    template <class Result> void descend(Place at, Vec3 outside, const Vec3& p, Result& result) const {
        while (at.node < nodes_.size()) {
            const Node& node = nodes_[at.node];
            const float above = p[node.axis] - node.plane;
            descend(above < 0 ? at.lower() : at.upper(), outside, p, result);
            outside[node.axis] = std::abs(above);
            if (too_far(outside, result)) return;
            at = above < 0 ? at.upper() : at.lower();
        }
        for (std::uint32_t i = at.begin; i < at.end; ++i) result.offer(i);
    }

    std::vector<Node> nodes_;
    std::uint32_t begin_ = 0, end_ = 0;
    Vec3 lower_{0}, upper_{0}; ///< bounds of all
};

} // namespace keyhole
