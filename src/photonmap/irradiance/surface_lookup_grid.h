// Which place of an irradiance map a point of a triangle belongs to, without a search.
#pragma once

#include "core/inline_vector.h"
#include "core/progress.h"
#include "scene/shape.h"
#include "scene/surface_point.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace keyhole {

/// Cells on the triangles of a scene, each with what a search from its middle found. Gather rays ask for places far
/// more often than there are any, so that the search for the nearest one took a third of their time. A small triangle
/// is a cell by itself. Where places are close to each other cells are divided further. Meshes of more triangles than
/// there is memory for, and sides of large triangles without any place, have none: there one has to search. Immutable
/// and thread-safe.
class SurfaceLookupGrid {
  public:
    static constexpr std::uint32_t kNothing = ~0u;     ///< the search finds no place
    static constexpr std::uint32_t kSearch = ~0u - 1u; ///< what it finds is not good for the whole cell

    struct Found {
        std::uint32_t place; ///< or kNothing
        float size;          ///< of the largest cell that this is good for [m]
    };
    /// What a search finds on the side of unit `normal`; thread-safe.
    using Find = std::function<Found(const Vec3& middle, const Vec3& normal)>;
    /// Takes `most` bytes at most. @throws Interrupted
    SurfaceLookupGrid(const std::vector<Shape>& shapes, std::size_t most, const Find& find, const RunContext& context);

    /// The place for a point of a surface, on the side of `normal`, kNothing or kSearch.
    std::uint32_t at(const SurfacePoint& point, const Vec3& normal) const;

    std::size_t bytes() const;

  private:
    static constexpr std::uint32_t kNone = ~0u;
    static constexpr std::uint32_t kGrid = 1u << 31;

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
        float size() const;
        /// The middle of one of `parts` x `parts` of a cell, or a place of the triangle near it.
        Vec3 middle(std::uint32_t column, std::uint32_t row, std::uint32_t parts, std::uint32_t part) const;
    };
    struct Cell {
        std::uint32_t place; ///< or, if divided, index of that of its first part
        std::uint32_t parts; ///< along each side: 1, unless divided
    };
    struct Triangle {
        std::uint32_t shape, triangle;
        double area;
        InlineVector<std::size_t, 2> sides; ///< that are to have cells
    };

    /// Makes entries for the meshes of the largest triangles, as many as there is memory for, and fills in those of
    /// triangles for which one place will do. Returns the others, largest first.
    std::vector<Triangle> index(const std::vector<Shape>& shapes, std::size_t most, const Find& find,
                                const RunContext& context);
    /// Gives grids to the largest of these, as many as there is memory for.
    void make_grids(const std::vector<Shape>& shapes, std::vector<Triangle> triangles, std::size_t most,
                    const Find& find, const RunContext& context);
    static Grid make_grid(const std::array<Vec3, 3>& p, double cell_area);
    static std::size_t entry_of(std::uint32_t triangle, std::size_t side) { return 2 * std::size_t{triangle} + side; }
    /// Searches from the middles of one side's cells.
    void fill(const Grid& grid, std::size_t side, const Find& find);
    /// Gives their parts to cells that want some, `most` in all.
    void divide(std::size_t most);
    /// Searches from the middles of these.
    void fill_parts(const Grid& grid, std::size_t side, const Find& find);

    /// By shape and entry_of() triangle and side: a place, kNothing or kSearch; or kGrid + the index of its grid.
    std::vector<std::vector<std::uint32_t>> entries_;
    std::vector<Grid> grids_;
    std::vector<Cell> cells_;
    std::vector<std::uint32_t> parts_; ///< places of the parts of divided cells
};

} // namespace keyhole
