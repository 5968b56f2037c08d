// Which of many balls a ray passes through.
#pragma once

#include "core/vec.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace keyhole {

struct Ball {
    Vec3 center; ///< world space [m]
    float radius;
};

/// Whether the ray from `origin` along `w` (unit) comes as near to the ball's center as its radius; always, if it
/// begins in the ball.
bool passes(const Ball& ball, const Vec3& origin, const Vec3& w);

/// A ball around them all.
Ball ball_around(std::span<const Ball> balls);

/// Bounding volume hierarchies over balls, one for each kind. Immutable and thread-safe.
class BallTree {
  public:
    /// None.
    BallTree();
    /// @param kinds  of each ball; none: all are of kind 0
    explicit BallTree(std::vector<Ball> balls, std::span<const std::uint32_t> kinds = {});
    ~BallTree();
    BallTree(BallTree&&) noexcept;
    BallTree& operator=(BallTree&&) noexcept;

    std::span<const Ball> balls() const { return balls_; }
    /// Indices of the balls of a kind that the ray passes(), ascending; until this thread asks again.
    std::span<const std::uint32_t> along(const Vec3& origin, const Vec3& w, std::uint32_t kind = 0) const;
    /// Memory, that of the balls included.
    std::size_t bytes() const;

  private:
    struct Embree;
    std::vector<Ball> balls_;
    std::unique_ptr<Embree> embree_; // refers to the balls: they stay where they are when this moves
};

} // namespace keyhole
