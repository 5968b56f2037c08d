// Directions to environments as wider cells have them, behind the histograms of small ones.
#pragma once

#include "sampling/guidance/learned/direction_histogram.h"
#include "sampling/guidance/learned/found_light.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace keyhole {

/// Cells over surfaces, and in each of them a rough histogram for every environment that was found. Immutable and
/// thread-safe.
class WiderCells {
  public:
    /// By emitter.
    using Directions = std::map<std::uint32_t, std::shared_ptr<const DirectionHistogram>>;

    /// @param least finds in each cell
    WiderCells(std::span<const FoundLight> found, std::size_t least);

    const Directions& at(const SurfaceCells::Place& place) const { return cells_[tree_.cell_of(place)]; }
    std::size_t bytes() const;

  private:
    SurfaceCells tree_;
    std::vector<Directions> cells_;
};

} // namespace keyhole
