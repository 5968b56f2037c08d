// By which of two techniques lobes at the ends of gather rays are asked for light.
#pragma once

#include "core/progress.h"

#include <cstdint>
#include <vector>

namespace keyhole {

class GatherRays;

/// What a lobe reflects (all of a surface without a diffuse part, the glossy part of a coated one) is told by photons
/// near where a gather ray ends, or by one more ray. Photons are best where light comes from a few directions, as on
/// the glass of a frosted bulb, whose filament rays hardly find; but where it comes from everywhere, as on a frosted
/// window, few of the photons lie in the lobe. Only noise depends on the choice. Immutable and thread-safe.
class LobeTechniques {
  public:
    /// A ray more, everywhere.
    LobeTechniques() = default;
    /// Measures the noise of both on what gather rays of visible points meet first, shape by shape.
    LobeTechniques(const GatherRays& rays, std::uint64_t seed, const RunContext& context);

    /// Whether photons tell what lobes of a shape reflect, where some are near.
    bool by_photons(std::uint32_t shape) const { return shape < by_photons_.size() && by_photons_[shape]; }

  private:
    std::vector<bool> by_photons_; // of the shapes
};

} // namespace keyhole
