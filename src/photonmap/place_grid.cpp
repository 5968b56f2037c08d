#include "photonmap/place_grid.h"

#include "core/parallel.h"
#include "scene/geometry.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

/// Triangles of fewer have none: what leads to cells is to be the lesser part.
constexpr double kLeastCells = 32;
constexpr double kMostRows = 2048;

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
            if (find(at.p, behind ? -at.ng : at.ng, 0) != PlaceGrid::kNothing) return true;
        }
    return false;
}

} // namespace

std::uint32_t PlaceGrid::Grid::cell(const Vec3& p) const {
    const auto step = [&](const Vec3& towards, std::uint32_t steps) {
        return static_cast<std::uint32_t>(
            std::clamp(static_cast<int>((p - corner).dot(towards)), 0, static_cast<int>(steps) - 1));
    };
    const std::uint32_t row = step(to_row, rows);
    return before(row) + step(to_column, in_row(row));
}

Vec3 PlaceGrid::Grid::middle(std::uint32_t column, std::uint32_t row) const {
    const float width = 1 / static_cast<float>(stretch * rows), height = 1 / static_cast<float>(rows);
    const float x = static_cast<float>(column) * width, y = static_cast<float>(row) * height;
    const float inside = std::max(0.0f, 1 - x - y); // the third edge cuts the last cells of a row
    return corner + along * (x + std::min(width / 2, inside / 3)) + across * (y + std::min(height / 2, inside / 3));
}

float PlaceGrid::Grid::size() const {
    return std::max(along.length() / static_cast<float>(stretch * rows), across.length() / static_cast<float>(rows));
}

PlaceGrid::PlaceGrid(const std::vector<Shape>& shapes, std::size_t most, const Find& find) : shapes_(shapes.size()) {
    struct Side {
        std::uint32_t shape, triangle;
        std::size_t side;
        double area;
    };
    double all = 0, area = 0;
    for (const Shape& shape : shapes)
        if (is_asked(shape)) all += surface_area(shape);
    std::vector<Side> sides;
    std::size_t indexed = 0;
    for (std::uint32_t s = 0; s < shapes.size(); ++s) {
        if (!is_asked(shapes[s])) continue;
        const auto& mesh = std::get<TriangleMesh>(shapes[s].geometry);
        if (indexed + mesh.triangles.size() > most / 4) continue; // its triangles are small, and their index is large
        indexed += mesh.triangles.size();
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const double own = triangle_area(mesh, t);
            if (!(own * static_cast<double>(most) > kLeastCells * all)) continue;
            for (const std::size_t side : {0, 1})
                if (has_places(mesh, t, side == 1, find)) {
                    sides.push_back({s, t, side, own});
                    area += own;
                }
        }
    }
    for (const Side& side : sides) {
        const auto& mesh = std::get<TriangleMesh>(shapes[side.shape].geometry);
        auto& grids = shapes_[side.shape];
        if (grids.empty()) grids.resize(mesh.triangles.size(), kNone);
        Grid grid = make_grid(mesh, side.triangle, area / static_cast<double>(most));
        const std::uint32_t cells = grid.before(grid.rows);
        if (places_.size() + cells > most) break;
        if (grids[side.triangle] == kNone) {
            grids[side.triangle] = static_cast<std::uint32_t>(grids_.size());
            grids_.push_back(grid);
        }
        grids_[grids[side.triangle]].first[side.side] = static_cast<std::uint32_t>(places_.size());
        places_.resize(places_.size() + cells);
    }
    grids_.shrink_to_fit();
    places_.shrink_to_fit();
    parallel_for(2 * static_cast<std::int64_t>(grids_.size()), [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        fill(grids_[k / 2], k % 2, find);
    });
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
    const double rows = std::clamp(std::floor(std::sqrt(n.length() / cell_area / stretch)), 1.0, kMostRows);
    grid.rows = static_cast<std::uint32_t>(rows);
    grid.stretch = static_cast<std::uint32_t>(stretch);
    grid.to_column = Vec3(f.cross(n) * (rows * stretch / n.length2()));
    grid.to_row = Vec3(n.cross(e) * (rows / n.length2()));
    return grid;
}

void PlaceGrid::fill(const Grid& grid, std::size_t side, const Find& find) {
    if (grid.first[side] == kNone) return;
    const Vec3 normal = side == 0 ? grid.normal : -grid.normal;
    std::uint32_t at = grid.first[side];
    for (std::uint32_t row = 0; row < grid.rows; ++row)
        for (std::uint32_t column = 0; column < grid.in_row(row); ++column)
            places_[at++] = find(grid.middle(column, row), normal, grid.size());
}

std::uint32_t PlaceGrid::at(const SurfacePoint& point, const Vec3& normal) const {
    if (point.shape >= shapes_.size() || shapes_[point.shape].empty()) return kSearch;
    const std::uint32_t g = shapes_[point.shape][point.primitive];
    if (g == kNone) return kSearch;
    const std::uint32_t first = grids_[g].first[point.ng.dot(normal) < 0 ? 1 : 0];
    return first == kNone ? kSearch : places_[first + grids_[g].cell(point.p)];
}

std::size_t PlaceGrid::bytes() const {
    std::size_t sum = grids_.capacity() * sizeof(Grid) + places_.capacity() * sizeof(std::uint32_t);
    for (const auto& shape : shapes_) sum += shape.capacity() * sizeof(std::uint32_t);
    return sum;
}

} // namespace keyhole
