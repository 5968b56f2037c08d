// A kd-tree that takes little memory beside its photons.
#pragma once

#include "photonmap/photon.h"
#include "photonmap/surface/surface_region.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <type_traits>
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

    /// Calls result.offer(i), i an index of the array, for every photon whose region.distance2() is at most
    /// result.bound() [m^2] at that time, and for some that are farther; nearer leaves first. These are few if
    /// Result::kFlat: a flat region passes by most of what the sphere around it would hold, such as the floor below a
    /// shelf. That pays where it is large and often holds nothing.
    template <class Result> void search(const SurfaceRegion& region, Result& result) const {
        if (nodes_.empty()) return;
        const Box all{lower_ - region.position, upper_ - region.position};
        const std::conditional_t<Result::kFlat, Box, Distances> extent(all);
        if (!extent.is_beyond(result.bound(), region.normal)) descend(0, extent, region, result);
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

    /// A node's box, from the middle of the region.
    struct Box {
        Vec3 lower, upper;

        /// Cuts off the lower part, which ends at `low` along an axis, or the upper one, which begins at `high`.
        Box cut_off(bool lower_part, int axis, float low, float high) {
            Box part = *this;
            (lower_part ? part.upper : part.lower)[axis] = lower_part ? low : high;
            (lower_part ? lower : upper)[axis] = lower_part ? high : low;
            return part;
        }
        float distance(int axis) const { return std::max({lower[axis], -upper[axis], 0.0f}); }
        /// Whether all of it lies farther away than the root of `bound`, by both terms of distance2() at their least.
        bool is_beyond(float bound, const Vec3& normal) const {
            float d2 = 0, low = 0, high = 0;
            for (int k = 0; k < 3; ++k) {
                d2 += distance(k) * distance(k);
                low += std::min(normal[k] * lower[k], normal[k] * upper[k]);
                high += std::max(normal[k] * lower[k], normal[k] * upper[k]);
            }
            return (d2 + SurfaceRegion::height_term(std::max({low, -high, 0.0f}))) * kRounding > bound;
        }
    };
    /// How far it is along each axis, which is kept up to date along the way (Arya and Mount 1993).
    struct Distances {
        Vec3 outside;

        explicit Distances(const Box& box) : outside(box.distance(0), box.distance(1), box.distance(2)) {}
        /// The same, of the nearer part: it is about as far as both.
        Distances cut_off(bool lower_part, int axis, float low, float high) {
            const Distances part = *this;
            outside[axis] = lower_part ? high : -low;
            return part;
        }
        bool is_beyond(float bound, const Vec3& /*normal*/) const { return outside.length2() * kRounding > bound; }
    };
    template <class Extent, class Result>
    void descend(std::uint32_t at, Extent extent, const SurfaceRegion& region, Result& result) const {
        while (!nodes_[at].is_leaf()) {
            const Node& node = nodes_[at];
            const int axis = node.axis();
            const float x = region.position[axis], low = node.low() - x, high = node.high() - x;
            const bool lower_first = low + high > 0;
            const Extent first = extent.cut_off(lower_first, axis, low, high);
            descend(lower_first ? at + 1 : node.upper(), first, region, result);
            if (extent.is_beyond(result.bound(), region.normal)) return;
            at = lower_first ? node.upper() : at + 1;
        }
        for (std::uint32_t i = nodes_[at].begin(); i < nodes_[at].end(); ++i) result.offer(i);
    }

    /// What is just as far as the bound must not be hidden.
    static constexpr float kRounding = 1 - 1e-5f;

    std::vector<Node> nodes_;
    Vec3 lower_{0}, upper_{0}; ///< bounds of all
};

} // namespace keyhole
