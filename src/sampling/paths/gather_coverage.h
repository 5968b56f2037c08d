// Where gather rays come often enough to be relied on.
#pragma once

#include "core/progress.h"
#include "sampling/paths/path.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace keyhole {

class Scene;

/// Sides of surfaces that gather rays from visible points meet. What lies behind a narrow door is met by so few of them
/// that the light it sends is noise in a final gather; paths of such light are stored where they are seen instead, and
/// gather rays don't count it. Either way a path counts once, wherever the border lies. Immutable and thread-safe;
/// the same whatever the seed of a render. A cell that a wall without thickness goes through has two sides, and light
/// in plenty beside the wall on that of the lamp: there places count as met where the ends of rays see them.
class GatherCoverage {
  public:
    /// Traces `paths` eye paths to where a gather ray would ask.
    /// @param scene must outlive this.
    /// @param max_scatterings as everywhere, of a whole path.
    /// @throws Interrupted
    GatherCoverage(const Scene& scene, int max_scatterings, std::int64_t paths = 1 << 16,
                   const RunContext& context = {});

    /// Whether rays come near `p` on the side of the unit geometric normal `n`.
    bool comes_to(const Vec3& p, const Vec3& n) const;
    /// Whether rays that can ask for light on that side do: where the surface lets light through, those on either.
    bool asks_for(const Vec3& p, const Vec3& n, bool through) const {
        return comes_to(p, n) || (through && comes_to(p, -n));
    }

  private:
    /// Around which rays end often enough.
    struct Cell {
        std::uint64_t key;
        std::uint32_t first = 0; ///< of its probes
        std::uint8_t probes = 0; ///< 0: nothing stands there that could hide a place from them
        std::uint8_t least = 1;  ///< so many of them have to see a place
    };

    std::uint64_t key(const Vec3& p, const Vec3& n) const;
    Vec3 above(const Vec3& p, const Vec3& n) const;
    bool obstructed(const Vec3& p, const Vec3& n) const;

    const Scene* scene_;
    Vec3 origin_;
    float size_ = 0;           // of a cell [m]
    std::vector<Cell> cells_;  // by key
    std::vector<Vec3> probes_; // above() the ends of rays in a cell and those around it
};

/// Whether gather rays come to `v` on the side of the unit direction `w`, or on any where light goes through. Vertices
/// are asked once: the answer is kept there. `coverage` null: they come everywhere.
inline bool is_covered(const GatherCoverage* coverage, Vertex& v, const Vec3& w) {
    if (coverage == nullptr) return true;
    const std::uint8_t side = KnownCoverage::side(v.point.ng, w);
    if ((v.coverage.asked & side) == 0) {
        v.coverage.asked |= side;
        if (coverage->asks_for(v.point.p, facing(v.point.ng, w), v.bsdf.traits().through)) v.coverage.covered |= side;
    }
    return (v.coverage.covered & side) != 0;
}

/// The share of the light on `paths` light paths, by the luminance of its power at each vertex after the first, that
/// arrives outside gather coverage. 0: final gather can do all. @throws Interrupted
double light_outside_coverage(const Scene& scene, const GatherCoverage& coverage, int max_scatterings,
                              std::int64_t paths = 1 << 13, const RunContext& context = {});

} // namespace keyhole
