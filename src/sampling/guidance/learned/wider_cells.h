// What shadow rays that count in no picture have found, and directions to environments as wider cells have them, behind
// the histograms of small ones.
#pragma once

#include "sampling/guidance/learned/direction_mixture.h"
#include "sampling/guidance/learned/surface_cells.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace keyhole {

/// Light that a shadow ray found: a sample of an emitter's point that is seen from a place.
struct FoundLight {
    SurfaceCells::Place at;
    std::uint32_t emitter;
    bool infinite;    ///< from an environment
    Vec3 towards;     ///< unit: where it came from
    double value;     ///< luminance that it would bring per unit of the coordinates of the emitter's point [W/m^2 / ..]
    double choice;    ///< probability of the emitter by the light tree
    double point_pdf; ///< of the point by the emitter
    double density{0}; ///< of all samples that were drawn in search of light, added up: balance heuristic
};

/// Cells over surfaces, and in each of them a rough histogram for every environment that was found. Immutable and
/// thread-safe.
class WiderCells {
  public:
    /// By emitter.
    using Directions = std::map<std::uint32_t, std::shared_ptr<const DirectionMixture>>;

    /// @param least finds in each cell
    WiderCells(std::span<const FoundLight> found, std::size_t least);

    const Directions& at(const SurfaceCells::Place& place) const { return cells_[tree_.cell_of(place)]; }
    std::size_t bytes() const;

  private:
    SurfaceCells tree_;
    std::vector<Directions> cells_;
};

/// Directions at the places of a cell, as its own finds and those of a wider cell have them.
///
/// What is seen past the edges of a window changes within a cell, so that its finds miss a strip of the sky here and
/// there. A wider cell knows of it: a share of the directions comes from its histogram. Immutable and thread-safe.
class NestedHistogram {
  public:
    /// @param wider histogram of the wider cell; may be null
    NestedHistogram(DirectionMixture own, std::shared_ptr<const DirectionMixture> wider)
        : own_(std::move(own)), wider_(std::move(wider)) {}

    const DirectionMixture& own() const { return own_; }
    /// Unit direction at `p` by two numbers in [0,1). Not to be called when empty.
    Vec3 sample(const Vec3& p, double u0, double u1) const;
    /// Density per solid angle with which sample() makes `w` at `p`.
    double pdf(const Vec3& p, const Vec3& w) const;
    /// Without the wider one, which is shared.
    std::size_t bytes() const { return own_.bytes(); }

  private:
    DirectionMixture own_;
    std::shared_ptr<const DirectionMixture> wider_;
};

} // namespace keyhole
