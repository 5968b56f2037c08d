#include "photonmap/place_grid.h"

#include "core/parallel.h"
#include "scene/geometry.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

// Shares of the memory, in cells of 8 bytes: an index of triangles, grids, cells, and parts of these of 4 bytes.
constexpr std::size_t kIndexedPerCell = 4, kCellsPerGrid = 44, kCellsPerUndivided = 4;
constexpr double kParts = 0.75;

constexpr double kLeastRows = 2, kMostRows = 2048;
constexpr float kMostParts = 64;

/// Whether gather rays ask for places there.
bool is_asked(const Shape& shape) {
    return !is_interface(shape) && shape.material != nullptr && shape.material->traits().finite &&
           std::holds_alternative<TriangleMesh>(shape.geometry);
}

/// Whether a search from any of some points of a triangle finds a place.
bool has_places(const TriangleMesh& mesh, std::uint32_t triangle, bool behind, const PlaceGrid::Find& find) {
    constexpr int kSteps = 6;
    for (int v = 1; v < kSteps; ++v)
        for (int u = 1; u + v < kSteps; ++u) {
            const SurfacePoint at = triangle_point(mesh, triangle, static_cast<float>(u) / kSteps,
                                                   static_cast<float>(v) / kSteps, /*parametrised=*/false);
            if (find(at.p, behind ? -at.ng : at.ng).place != PlaceGrid::kNothing) return true;
        }
    return false;
}

} // namespace

float PlaceGrid::Grid::size() const {
    return std::max(along.length() / static_cast<float>(stretch * rows), across.length() / static_cast<float>(rows));
}

Vec3 PlaceGrid::Grid::middle(std::uint32_t column, std::uint32_t row, std::uint32_t parts, std::uint32_t part) const {
    const float width = 1 / static_cast<float>(stretch * rows * parts), height = 1 / static_cast<float>(rows * parts);
    const float x = static_cast<float>(column * parts + part % parts) * width;
    const float y = static_cast<float>(row * parts + part / parts) * height;
    const float inside = std::max(0.0f, 1 - x - y); // the third edge cuts the last cells of a row
    return corner + along * (x + std::min(width / 2, inside / 3)) + across * (y + std::min(height / 2, inside / 3));
}

std::vector<PlaceGrid::Side> PlaceGrid::choose_sides(const std::vector<Shape>& shapes, std::size_t most,
                                                     const Find& find) {
    struct Triangle {
        std::uint32_t shape, triangle;
        double area;
    };
    std::vector<Triangle> triangles;
    std::size_t indexed = 0;
    for (std::uint32_t s = 0; s < shapes.size(); ++s) {
        if (!is_asked(shapes[s])) continue;
        const auto& mesh = std::get<TriangleMesh>(shapes[s].geometry);
        if (indexed + mesh.triangles.size() > most / kIndexedPerCell) continue; // of small triangles
        indexed += mesh.triangles.size();
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
            if (const double area = triangle_area(mesh, t); area > 0) triangles.push_back({s, t, area});
    }
    std::ranges::stable_sort(triangles, std::greater(), &Triangle::area);
    triangles.resize(std::min(triangles.size(), most / kCellsPerGrid));
    std::vector<Side> sides;
    for (const Triangle& t : triangles)
        for (const std::size_t side : {0, 1})
            if (has_places(std::get<TriangleMesh>(shapes[t.shape].geometry), t.triangle, side == 1, find))
                sides.push_back({t.shape, t.triangle, side, t.area});
    return sides;
}

PlaceGrid::PlaceGrid(const std::vector<Shape>& shapes, std::size_t most, const Find& find) : shapes_(shapes.size()) {
    const std::vector<Side> sides = choose_sides(shapes, most, find);
    double area = 0;
    for (const Side& side : sides) area += side.area;
    const std::size_t undivided = most / kCellsPerUndivided;
    for (const Side& side : sides) {
        const auto& mesh = std::get<TriangleMesh>(shapes[side.shape].geometry);
        auto& grids = shapes_[side.shape];
        if (grids.empty()) grids.resize(mesh.triangles.size(), kNone);
        // The other half is for small ones, which have more than their share.
        Grid grid = make_grid(mesh, side.triangle, 2 * area / static_cast<double>(undivided));
        const std::uint32_t cells = grid.before(grid.rows);
        if (cells_.size() + cells > undivided) break;
        if (grids[side.triangle] == kNone) {
            grids[side.triangle] = static_cast<std::uint32_t>(grids_.size());
            grids_.push_back(grid);
        }
        grids_[grids[side.triangle]].first[side.side] = static_cast<std::uint32_t>(cells_.size());
        cells_.resize(cells_.size() + cells);
    }
    grids_.shrink_to_fit();
    cells_.shrink_to_fit();
    const auto each_side = [&](auto&& body) {
        parallel_for(2 * static_cast<std::int64_t>(grids_.size()), [&](std::int64_t i) {
            const Grid& grid = grids_[static_cast<std::size_t>(i / 2)];
            const auto side = static_cast<std::size_t>(i % 2);
            if (grid.first[side] != kNone) body(grid, side);
        });
    };
    each_side([&](const Grid& grid, std::size_t side) { fill(grid, side, find); });
    divide(static_cast<std::size_t>(kParts * static_cast<double>(most)));
    each_side([&](const Grid& grid, std::size_t side) { fill_parts(grid, side, find); });
}

PlaceGrid::Grid PlaceGrid::make_grid(const TriangleMesh& mesh, std::uint32_t triangle, double cell_area) {
    std::array<Vec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.positions[mesh.triangles[triangle][i]];
    // From the corner opposite the longest edge the other two make cells that are least askew.
    std::size_t corner = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if ((p[(i + 1) % 3] - p[(i + 2) % 3]).length2() > (p[(corner + 1) % 3] - p[(corner + 2) % 3]).length2())
            corner = i;
    Grid grid{.normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized(),
              .corner = p[corner],
              .along = p[(corner + 1) % 3] - p[corner],
              .across = p[(corner + 2) % 3] - p[corner],
              .to_column{},
              .to_row{},
              .rows = 0,
              .stretch = 0};
    if (grid.along.length2() < grid.across.length2()) std::swap(grid.along, grid.across);
    const Imath::V3d e(grid.along), f(grid.across), n = e.cross(f);
    const double stretch = std::clamp(std::round(e.length() / f.length()), 1.0, kMostRows);
    // Half of rows^2 stretch cells lie inside, and half of those of the last ones.
    const double rows = std::clamp(std::floor(std::sqrt(n.length() / cell_area / stretch)), kLeastRows, kMostRows);
    grid.rows = static_cast<std::uint32_t>(rows);
    grid.stretch = static_cast<std::uint32_t>(stretch);
    grid.to_column = Vec3(f.cross(n) * (rows * stretch / n.length2()));
    grid.to_row = Vec3(n.cross(e) * (rows / n.length2()));
    return grid;
}

void PlaceGrid::fill(const Grid& grid, std::size_t side, const Find& find) {
    const Vec3 normal = side == 0 ? grid.normal : -grid.normal;
    std::uint32_t at = grid.first[side];
    for (std::uint32_t row = 0; row < grid.rows; ++row)
        for (std::uint32_t column = 0; column < grid.in_row(row); ++column) {
            const Found found = find(grid.middle(column, row, 1, 0), normal);
            const float parts = std::ceil(grid.size() / found.size);
            cells_[at++] = {found.place, static_cast<std::uint32_t>(std::clamp(parts, 1.0f, kMostParts))};
        }
}

void PlaceGrid::divide(std::size_t most) {
    std::size_t parts = 0;
    for (Cell& cell : cells_) {
        if (cell.parts == 1) continue;
        const std::size_t wanted = std::size_t{cell.parts} * cell.parts;
        if (parts + wanted > most) {
            cell = {kSearch, 1};
        } else {
            cell.place = static_cast<std::uint32_t>(parts);
            parts += wanted;
        }
    }
    parts_.resize(parts);
    parts_.shrink_to_fit();
}

void PlaceGrid::fill_parts(const Grid& grid, std::size_t side, const Find& find) {
    const Vec3 normal = side == 0 ? grid.normal : -grid.normal;
    std::uint32_t at = grid.first[side];
    for (std::uint32_t row = 0; row < grid.rows; ++row)
        for (std::uint32_t column = 0; column < grid.in_row(row); ++column) {
            const Cell& cell = cells_[at++];
            for (std::uint32_t i = 0; cell.parts > 1 && i < cell.parts * cell.parts; ++i) {
                const Found found = find(grid.middle(column, row, cell.parts, i), normal);
                const bool good = grid.size() <= static_cast<float>(cell.parts) * found.size;
                parts_[cell.place + i] = good ? found.place : kSearch;
            }
        }
}

std::uint32_t PlaceGrid::at(const SurfacePoint& point, const Vec3& normal) const {
    if (point.shape >= shapes_.size() || shapes_[point.shape].empty()) return kSearch;
    const std::uint32_t g = shapes_[point.shape][point.primitive];
    if (g == kNone) return kSearch;
    const Grid& grid = grids_[g];
    const std::uint32_t first = grid.first[point.ng.dot(normal) < 0 ? 1 : 0];
    if (first == kNone) return kSearch;
    // Rounding may bring points of an edge to the other side of it.
    const auto step = [](float x, std::uint32_t steps) {
        return static_cast<std::uint32_t>(std::clamp(static_cast<int>(x), 0, static_cast<int>(steps) - 1));
    };
    const Vec3 from_corner = point.p - grid.corner;
    const float x = from_corner.dot(grid.to_column), y = from_corner.dot(grid.to_row);
    const std::uint32_t row = step(y, grid.rows), column = step(x, grid.in_row(row));
    const Cell& cell = cells_[first + grid.before(row) + column];
    if (cell.parts == 1) return cell.place;
    const auto part = [&](float of_grid, std::uint32_t of_cell) {
        return step((of_grid - static_cast<float>(of_cell)) * static_cast<float>(cell.parts), cell.parts);
    };
    return parts_[cell.place + part(y, row) * cell.parts + part(x, column)];
}

std::size_t PlaceGrid::bytes() const {
    std::size_t sum =
        grids_.capacity() * sizeof(Grid) + cells_.capacity() * sizeof(Cell) + parts_.capacity() * sizeof(std::uint32_t);
    for (const auto& shape : shapes_) sum += shape.capacity() * sizeof(std::uint32_t);
    return sum;
}

} // namespace keyhole
