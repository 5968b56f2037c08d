// Directions that lead through several windows, learned from directions that light came from.
#pragma once

#include "sampling/guidance/learned/direction_histogram.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace keyhole {

/// A mixture of histograms, each of the rays that lead towards one window, or a few that lie in one wall: rays through
/// windows in different walls meet in no plane. With one of them it is that histogram. Immutable and thread-safe.
class DirectionMixture {
  public:
    using Ray = DirectionHistogram::Ray;
    /// Rays that belong together: those that lead towards `aim` better than towards that of any other group.
    struct Group {
        Vec3 aim; ///< a place in world space [m], or a unit direction
        bool is_place = false;
        std::optional<DirectionHistogram::Plane> plane{};
    };
    /// As many groups as make held-out rays likeliest.
    static std::vector<Group> groups_of(std::span<const Ray> rays);

    DirectionMixture() = default;
    /// Empty for too few rays, or none with a weight.
    DirectionMixture(std::span<const Ray> rays, std::span<const Group> groups);

    bool empty() const { return parts_.empty(); }
    std::size_t size() const { return parts_.size(); }
    const std::vector<Group>& groups() const { return groups_; }
    /// Unit direction at `p` by two numbers in [0,1). Not to be called when empty.
    Vec3 sample(const Vec3& p, double u0, double u1) const;
    /// Density per solid angle with which sample() makes `w` at `p`, for who knows place_on_map(w).
    double pdf(const Vec3& p, const Vec3& w, const DirectionHistogram::Place& on_map) const;
    std::size_t bytes() const;

  private:
    struct Part {
        DirectionHistogram directions;
        double share; ///< of all directions
    };
    std::vector<Group> groups_;
    std::vector<Part> parts_;
};

} // namespace keyhole
