// Where gather rays come often enough to be relied on.
#pragma once

#include "core/vec.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace keyhole {

class Scene;

/// Sides of surfaces that gather rays from visible points meet. What lies behind a narrow door is met by so few of them
/// that the light it sends is noise in a final gather; paths of such light are stored where they are seen instead, and
/// gather rays don't count it. Either way a path counts once, wherever the border lies. Immutable and thread-safe;
/// the same whatever the seed of a render.
class Reach {
  public:
    /// Traces `paths` eye paths to where a gather ray would ask.
    /// @param max_scatterings as everywhere, of a whole path.
    Reach(const Scene& scene, int max_scatterings, std::int64_t paths = 1 << 16);

    /// Whether rays come near `p` on the side of the unit geometric normal `n`.
    bool comes_to(const Vec3& p, const Vec3& n) const;

  private:
    std::uint64_t cell(const Vec3& p, const Vec3& n) const;

    Vec3 origin_;
    float size_ = 0;                   // of a cell [m]
    std::vector<std::uint64_t> cells_; // those that rays come to, sorted
};

/// The share of the light on `paths` light paths, by the luminance of its power at each vertex after the first, that
/// arrives beyond reach. 0: final gather can do all.
double light_beyond_reach(const Scene& scene, const Reach& reach, int max_scatterings, std::int64_t paths = 1 << 13);

} // namespace keyhole
