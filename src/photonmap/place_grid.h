// Which place of an irradiance map a point of a large triangle belongs to, without a search.
#pragma once

#include "scene/shape.h"
#include "scene/surface_point.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace keyhole {

/// Cells on the triangles of a scene, each with what a search from its middle found. Gather rays ask for places far
/// more often than there are any, so that the search for the nearest one took a third of their time. Triangles smaller
/// than some cells, and sides without any place, have none: there one has to search. Immutable and thread-safe.
class PlaceGrid {
  public:
    static constexpr std::uint32_t kNothing = ~0u;     ///< the search finds no place
    static constexpr std::uint32_t kSearch = ~0u - 1u; ///< what it finds is not good for the whole cell

    /// About `most` cells at most. `find(middle, normal, size)`: the place for a cell of that length [m] on the side of
    /// unit `normal`, kNothing or kSearch; thread-safe.
    using Find = std::function<std::uint32_t(const Vec3& middle, const Vec3& normal, float size)>;
    PlaceGrid(const std::vector<Shape>& shapes, std::size_t most, const Find& find);

    /// The place for a point of a surface, on the side of `normal`, kNothing or kSearch.
    std::uint32_t at(const SurfacePoint& point, const Vec3& normal) const;

    std::size_t bytes() const;
    /// For one of the `most` cells, at most [bytes]: itself, and its part of what leads to it.
    static constexpr std::size_t bytes_per_cell() { return 8; }

  private:
    static constexpr std::uint32_t kNone = ~0u;

    /// Steps along two edges of a triangle, `stretch` times as many along the longer one. Cells that lie inside, if
    /// only in part, follow each other row by row.
    struct Grid {
        Vec3 normal;                ///< unit, of the outside
        Vec3 corner, along, across; ///< the edges from there, the longer one first
        Vec3 to_column, to_row;     ///< (p - corner) . to_row is the number of steps along `across`
        std::uint32_t rows, stretch;
        std::array<std::uint32_t, 2> first{kNone, kNone}; ///< cell of each side; kNone: that has none

        /// Cells before a row; all, for the one after the last.
        std::uint32_t before(std::uint32_t row) const { return stretch * (row * (2 * rows + 1 - row) / 2); }
        std::uint32_t in_row(std::uint32_t row) const { return stretch * (rows - row); }
        std::uint32_t cell(const Vec3& p) const;
        /// A place in a cell and in the triangle, not far from the middle.
        Vec3 middle(std::uint32_t column, std::uint32_t row) const;
        float size() const;
    };
    static Grid make_grid(const TriangleMesh& mesh, std::uint32_t triangle, double cell_area);
    void fill(const Grid& grid, std::size_t side, const Find& find);

    std::vector<std::vector<std::uint32_t>> shapes_; ///< by shape and triangle: index of its grid, or kNone
    std::vector<Grid> grids_;
    std::vector<std::uint32_t> places_;
};

} // namespace keyhole
