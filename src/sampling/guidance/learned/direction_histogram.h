// A density of directions at neighbouring places, learned from directions that light came from.
#pragma once

#include "core/vec.h"

#include <Imath/ImathBox.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace keyhole {

/// A density over a part of a plane: rectangles around the points of the leaves of a k-d tree, each with the share of
/// their weight, spread evenly; a small part of a node's share is spread over the rectangle around all of its points.
/// Besides, a part of all samples is spread evenly over the box and its surroundings: points end a little before what
/// they were drawn from does, and what lies beyond them must not be found by the rarest of chances alone. Immutable and
/// thread-safe.
class PlaneHistogram {
  public:
    using Place = Imath::V2d;
    struct Point {
        Place x;
        double weight; ///< not negative
    };

    PlaneHistogram() = default;
    /// @param points are reordered; those of one place only, or of no weight, make it empty
    /// @param leaf points of one, at least
    /// @param limits where surroundings end
    PlaneHistogram(std::span<Point> points, std::size_t leaf,
                   const Imath::Box2d& limits = {{-1e30, -1e30}, {1e30, 1e30}});

    bool empty() const { return nodes_.empty(); }
    /// A place by two numbers in [0,1). Not to be called when empty.
    Place sample(double u0, double u1) const;
    /// Density per area; 0 beyond the surroundings of the bounding box.
    double pdf(const Place& place) const;
    std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }

  private:
    struct Node {
        Imath::Box2f box; ///< around its points
        float density;    ///< per area, of what a node spreads over all of its box
        float split = 0;
        float left_share = 0;
        std::uint32_t right : 31 = 0; ///< the left child follows its parent; 0: a leaf
        std::uint32_t axis : 1 = 0;
    };
    Place sample_tree(double u0, double u1) const;
    double tree_pdf(const Place& place) const;
    void build(std::span<Point> points, const Imath::Box2d& box, std::size_t leaf);

    Imath::Box2d around_;
    std::vector<Node> nodes_;
};

/// Directions that lead through a window differ from place to place, but they meet in it. Where the rays come together,
/// the density is one over a plane there, and serves all places; else it is one over the octahedral map of directions.
/// Immutable and thread-safe.
class DirectionHistogram {
  public:
    struct Ray {
        Vec3 p;        ///< world space [m]
        Vec3 w;        ///< unit
        double weight; ///< not negative
    };

    struct Plane {
        Vec3 center; ///< world space [m]
        Vec3 n;      ///< unit, on the side that rays leave to
    };
    /// The point with the least sum of squared distances to all rays; none where they are parallel.
    static std::optional<Vec3> meeting_point(std::span<const Ray> rays);
    /// Where rays meet; none: nowhere that would tell more of directions than the octahedral map.
    static std::optional<Plane> meeting_plane(std::span<const Ray> rays);

    DirectionHistogram() = default;
    /// Over `plane`, or over the octahedral map without one. Empty for too few rays, or none with a weight.
    DirectionHistogram(std::span<const Ray> rays, const std::optional<Plane>& plane);

    bool empty() const { return octahedral_.empty(); }
    const std::optional<Plane>& plane() const { return plane_; }
    /// Unit direction at `p` by two numbers in [0,1). Not to be called when empty.
    Vec3 sample(const Vec3& p, double u0, double u1) const;
    /// Density per solid angle with which sample() makes `w` at `p`.
    double pdf(const Vec3& p, const Vec3& w) const { return pdf(p, w, place_on_map(w)); }

    /// The parts of which that is made: a point of the plane, where there is one with a histogram, by its density per
    /// area [1/m^2], and a direction by the octahedral map, per solid angle.
    bool has_plane() const { return !histogram_.empty(); }
    Vec3 sample_on_plane(double u0, double u1) const;
    /// Where the line through `p` along `w` meets the plane, with that density over the cosine there; none where it
    /// doesn't.
    struct OnPlane {
        Vec3 q;
        double pdf;
    };
    std::optional<OnPlane> on_plane(const Vec3& p, const Vec3& w) const;
    Vec3 sample_on_map(double u0, double u1) const;
    using Place = PlaneHistogram::Place;
    static Place place_on_map(const Vec3& w);
    double pdf_on_map(const Place& place) const;
    /// pdf() for who knows place_on_map(w).
    double pdf(const Vec3& p, const Vec3& w, const Place& on_map) const;
    /// Of all directions, those that are drawn from the octahedral map where there is a plane: those that are flat to
    /// it must not be left to chance.
    static constexpr double kNotOnPlane = 0.15;

    std::size_t bytes() const { return histogram_.bytes() + octahedral_.bytes(); }

  private:
    /// Of all directions at `p`, those that are drawn from the octahedral map.
    double share_of_octahedron(const Vec3& p) const;
    std::optional<Plane> plane_;
    Frame frame_{Vec3(0, 0, 1)}; // of the plane
    PlaneHistogram histogram_, octahedral_;
};

/// Every other of them, and the rest: each half judges what was learned from the other.
template <class T> std::array<std::vector<T>, 2> halves_of(std::span<const T> found) {
    std::array<std::vector<T>, 2> halves;
    for (std::size_t i = 0; i < found.size(); ++i) halves[i % 2].push_back(found[i]);
    return halves;
}

/// Logarithm of the density of rays, by weight, to tell which of two densities of directions is better. What one
/// doesn't know has some density all the same.
/// @param density at a place, of a direction from there [1/sr]
template <class Density> double log_likelihood(std::span<const DirectionHistogram::Ray> rays, const Density& density) {
    constexpr double kUnknown = 1e-3;
    double sum = 0;
    for (const auto& ray : rays) sum += ray.weight * std::log(kUnknown + density(ray.p, ray.w));
    return sum;
}

} // namespace keyhole
