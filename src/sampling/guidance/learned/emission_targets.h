// Where light is sent first, and from where: a density of the first edges of light paths.
#pragma once

#include "sampling/guidance/learned/direction_histogram.h"
#include "sampling/guidance/learned/look_for_light.h"
#include "sampling/guidance/learned/surface_cells.h"
#include "scene/scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace keyhole {

/// The first edge of a light path. The density of `ray` isn't set.
struct FirstEdge {
    SurfacePoint x0;
    EmitterRay ray;
};

/// A kernel density estimate (Silverman 1986, section 5.3, with a radius for each sample) of where light that counts
/// first arrives, over the places where paths from the eye found such light. Surfaces are divided into cells by place
/// and normal. A target is drawn by its share of the light, a point on its emitter (towards an environment: from the
/// cell's histogram of directions), and a line through the disc across that direction around the target. The edge
/// stands if it ends in the target's cell: so its density is that of the cell in which it ends, whatever lies before
/// others. Immutable and thread-safe.
class EmissionTargets {
  public:
    EmissionTargets() = default;
    /// @param seen in any order; there may be nothing
    EmissionTargets(const Scene& scene, std::span<const SeenLight> seen);

    bool empty() const { return cells_.empty(); }

    struct Drawn {
        FirstEdge edge;
        std::uint32_t cell; ///< in which it has to end
    };
    /// By `u` in [0,1) and more numbers. None where the target lies in the emitter's point. Not to be called when
    /// empty.
    std::optional<Drawn> sample(double u, SampleSource& source) const;
    /// That in which an edge ends at `x1`, along `w` (unit).
    std::uint32_t cell_of(const SurfacePoint& x1, const Vec3& w) const {
        return tree_.cell_of({x1.p, facing(x1.ng, -w)});
    }
    /// Density with which sample() makes an edge from `x0` that ends at `x1` and stands: that of the emitter's point
    /// times that of EmitterRay.
    double pdf(const SurfacePoint& x0, const SurfacePoint& x1) const;
    std::size_t bytes() const;

  private:
    /// Targets of one emitter in a cell.
    struct Share {
        std::uint32_t emitter;
        std::size_t begin, end;
        DirectionHistogram directions; ///< towards an environment; empty: points by the emitter
    };
    struct Cell {
        double weight = 0;
        std::vector<float> x[3];         ///< of targets, world space [m]; an array for each axis
        std::vector<float> radius;       ///< [m]
        std::vector<double> probability; ///< of a target
        std::vector<double> up_to;       ///< sums of these so far
        std::vector<Share> shares;       ///< by emitter

        Vec3 at(std::size_t i) const { return {x[0][i], x[1][i], x[2][i]}; }
    };
    static Cell make_cell(std::span<const SeenLight* const> seen, float least_radius);
    double pdf_of_targets(const Cell& cell, const Share& share, const SurfacePoint& x0, const SurfacePoint& x1) const;

    const Scene* scene_ = nullptr;
    SurfaceCells tree_;
    EmitterDistribution choice_; // of a cell
    std::vector<Cell> cells_;
};

} // namespace keyhole
