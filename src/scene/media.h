// Absorption along the edges of paths.
#pragma once

#include "scene/accelerator.h"
#include "scene/medium.h"

#include <memory>
#include <vector>

namespace keyhole {

/// Where along a ray the search for its next boundary begins, once a search from `nearest` has met one at `met`: at
/// least `skip` beyond it, and always farther on than before. An accelerator may find what lies a rounding error before
/// where it was told to begin, and would find that for ever.
float beyond_boundary(float nearest, float met, float skip);

/// Knows which medium lies where from the shapes whose sides differ in it. An edge asks for itself, with a ray that
/// meets nothing but those shapes: nobody carries a medium along a path, and both directions of transport get the same
/// answer. Thread-safe. Invariant: without media, nothing is built and nothing is asked.
class Media {
  public:
    /// `shapes` must outlive this. `outermost` fills what no shape encloses; null: vacuum.
    Media(const std::vector<Shape>& shapes, std::shared_ptr<const Medium> outermost);

    bool empty() const { return accelerator_ == nullptr && outermost_ == nullptr; }
    std::size_t accelerator_bytes() const { return accelerator_ ? accelerator_->bytes() : 0; }

    /// Share of light that an edge between two points lets through. At most one of them is infinite.
    Rgb transmittance(const SurfacePoint& a, const SurfacePoint& b) const;

  private:
    const Medium* medium_beside(const SurfacePoint& point, const Vec3& w) const;

    const std::vector<Shape>& shapes_;
    std::shared_ptr<const Medium> outermost_;
    std::unique_ptr<Accelerator> accelerator_; // over the boundaries; null if there are none
};

} // namespace keyhole
