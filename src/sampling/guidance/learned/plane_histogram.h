// A density over a part of a plane, learned from points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace keyhole {

/// Rectangles of a k-d tree, each with the share of the weight of the points in it, spread evenly; a small part of a
/// node's share is divided by area, so that nowhere in the points' bounding box is it 0. Besides, a part of all samples
/// is spread evenly over the box and its surroundings: points end a little before what they were drawn from does, and
/// what lies beyond them must not be found by the rarest of chances alone. Immutable and thread-safe.
class PlaneHistogram {
  public:
    struct Point {
        double x[2];
        double weight; ///< not negative
    };

    struct Box {
        double lower[2], upper[2];
        double area() const { return (upper[0] - lower[0]) * (upper[1] - lower[1]); }
    };
    static constexpr Box kPlane{{-1e30, -1e30}, {1e30, 1e30}};

    PlaneHistogram() = default;
    /// Reorders the points. Those of one place only, or of no weight, make it empty. Surroundings end at `limits`.
    explicit PlaneHistogram(std::span<Point> points, const Box& limits = kPlane);

    bool empty() const { return nodes_.empty(); }
    /// A place by two numbers in [0,1). Not to be called when empty.
    struct Place {
        double x[2];
    };
    Place sample(double u0, double u1) const;
    /// Density per area; 0 beyond the surroundings of the bounding box.
    double pdf(const Place& place) const;
    std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }

  private:
    struct Node {
        double split = 0;
        double left_share = 0;
        std::uint32_t right = 0; ///< the left child follows its parent; 0: a leaf
        std::uint8_t axis = 0;
    };
    Place sample_tree(double u0, double u1) const;
    double tree_pdf(const Place& place) const;
    void build(std::span<Point> points, const Box& box, int depth);

    Box box_{}, around_{};
    std::vector<Node> nodes_;
};

} // namespace keyhole
