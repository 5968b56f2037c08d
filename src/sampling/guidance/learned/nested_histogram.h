// Directions at the places of a cell, as its own finds and those of a wider cell have them.
#pragma once

#include "sampling/guidance/learned/direction_histogram.h"

#include <cstddef>
#include <memory>
#include <utility>

namespace keyhole {

/// What is seen past the edges of a window changes within a cell, so that its finds miss a strip of the sky here and
/// there. A wider cell knows of it: a share of the directions comes from its histogram. Immutable and thread-safe.
class NestedHistogram {
  public:
    NestedHistogram() = default;
    /// @param wider histogram of the wider cell; may be null
    NestedHistogram(DirectionHistogram own, std::shared_ptr<const DirectionHistogram> wider)
        : own_(std::move(own)), wider_(std::move(wider)) {}

    bool empty() const { return own_.empty(); }
    const DirectionHistogram& own() const { return own_; }
    /// Unit direction at `p` by two numbers in [0,1). Not to be called when empty.
    Vec3 sample(const Vec3& p, double u0, double u1) const;
    /// Density per solid angle with which sample() makes `w` at `p`.
    double pdf(const Vec3& p, const Vec3& w) const;
    /// Without the wider one, which is shared.
    std::size_t bytes() const { return own_.bytes(); }

  private:
    DirectionHistogram own_;
    std::shared_ptr<const DirectionHistogram> wider_;
};

} // namespace keyhole
