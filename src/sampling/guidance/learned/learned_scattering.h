// Where light goes on to from surfaces, on its way to where photons are wanted.
#pragma once

#include "sampling/guidance/learned/direction_histogram.h"
#include "sampling/guidance/learned/surface_cells.h"
#include "sampling/paths/walk.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace keyhole {

/// A vertex, that isn't specular, of a path from the eye to a light, between the light and where the path stores a
/// photon.
struct SeenScattering {
    SurfaceCells::Place at; ///< the normal on the side that light comes from
    Vec3 towards;           ///< unit, where it goes on
    double pdf;             ///< per solid angle, with which the BSDF would send it there
    double weight;          ///< luminance of the path in the picture
};

/// Directions in which light paths go on, learned from paths from the eye (as incident importance: Vorba et al. 2014,
/// "On-line Learning of Parametric Mixture Models for Light Transport Simulation"): light on a lawn goes on to the
/// window, and light in a lobby to the crack of the door. Surfaces are divided into cells by place and normal, each
/// with a histogram of directions. Of all directions a share is drawn from the BSDF as if nothing were known: in each
/// cell that which leaves the paths that it was not made from the least second moment; all, where the histogram
/// wouldn't lower that by much. Immutable and thread-safe.
class LearnedScattering {
  public:
    /// @param seen in any order; may be empty
    explicit LearnedScattering(std::span<const SeenScattering> seen);

    /// Whether any cell goes by its histogram.
    bool helps() const { return helped_ > 0; }
    /// Share of the light that such cells are about.
    double helped_share() const { return helped_; }

    /// As continue_walk() from the light, and the same in expectation: the density of a finite event is that of the
    /// mixture. What a free walk would carry, `reference` [any unit of power], is brought to what one of such density
    /// would: roulette that held on to it would take back what the histogram gives.
    std::optional<Continuation> continue_walk(const Vertex& v, const Vec3& to_light, SampleSource& source,
                                              double& reference) const;

    std::size_t bytes() const;

  private:
    struct Cell {
        double plain = 1; ///< share of the directions by the BSDF
        DirectionHistogram directions;
    };
    /// @param found the scatterings of one cell
    static Cell make_cell(std::span<const SeenScattering* const> found);
    const Cell& cell_at(const SurfaceCells::Place& place) const { return cells_[tree_.cell_of(place)]; }

    SurfaceCells tree_;
    std::vector<Cell> cells_;
    double helped_ = 0;
};

} // namespace keyhole
