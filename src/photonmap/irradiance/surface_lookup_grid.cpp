#include "photonmap/irradiance/surface_lookup_grid.h"

#include "core/shared_work.h"
#include "scene/geometry.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

// Shares of the memory: entries of triangles, grids and cells have so much at most, and parts of cells the rest.
constexpr double kEntries = 0.25, kGrids = 0.125, kCells = 0.1875;

constexpr std::int64_t kSidesOfBlock = 256; // sides of triangles between two looks at the clock
constexpr double kLeastRows = 2, kMostRows = 2048;
constexpr float kMostParts = 64;

/// Whether gather rays ask for places there.
bool is_asked(const Shape& shape) {
    return !is_interface(shape) && shape.material != nullptr && shape.material->traits().finite &&
           !std::holds_alternative<Sphere>(shape.geometry);
}

/// Whether a search from any of some points of a triangle finds a place.
bool has_places(const Shape& shape, std::uint32_t triangle, bool behind, const SurfaceLookupGrid::Find& find) {
    constexpr int kSteps = 6;
    for (int v = 1; v < kSteps; ++v)
        for (int u = 1; u + v < kSteps; ++u) {
            const SurfacePoint at = triangle_point(shape, triangle, static_cast<float>(u) / kSteps,
                                                   static_cast<float>(v) / kSteps, /*parametrised=*/false);
            if (find(at.p, behind ? -at.ng : at.ng).place != SurfaceLookupGrid::kNothing) return true;
        }
    return false;
}

/// The place for all of a triangle's side, kNothing or kSearch.
std::uint32_t place_for_all(const Shape& shape, std::uint32_t triangle, bool behind,
                            const SurfaceLookupGrid::Find& find) {
    const SurfacePoint at = triangle_point(shape, triangle, 1 / 3.0f, 1 / 3.0f, /*parametrised=*/false);
    const SurfaceLookupGrid::Found found = find(at.p, behind ? -at.ng : at.ng);
    const auto [a, b, c] = triangle_corners(shape, triangle);
    const float longest = std::max({(b - a).length(), (c - b).length(), (a - c).length()});
    return longest <= found.size ? found.place : SurfaceLookupGrid::kSearch;
}

/// Of copies by some of the triangles: there may be more in them than one has time for.
double mean_triangle_area(const Shape& shape) {
    constexpr std::size_t kSome = 64;
    const std::size_t n = triangle_count(shape);
    if (!std::holds_alternative<MeshInstance>(shape.geometry)) return surface_area(shape) / static_cast<double>(n);
    const std::size_t some = std::min(n, kSome);
    double sum = 0;
    for (std::size_t i = 0; i < some; ++i) sum += triangle_area(shape, static_cast<std::uint32_t>(i * n / some));
    return sum / static_cast<double>(some);
}

} // namespace

float SurfaceLookupGrid::Grid::size() const {
    return std::max(along.length() / static_cast<float>(stretch * rows), across.length() / static_cast<float>(rows));
}

Vec3 SurfaceLookupGrid::Grid::middle(std::uint32_t column, std::uint32_t row, std::uint32_t parts,
                                     std::uint32_t part) const {
    const float width = 1 / static_cast<float>(stretch * rows * parts), height = 1 / static_cast<float>(rows * parts);
    const std::uint32_t right = part % parts, up = part / parts;
    const float x = static_cast<float>(column * parts + right) * width;
    const float y = static_cast<float>(row * parts + up) * height;
    const float inside = std::max(0.0f, 1 - x - y); // the third edge cuts the last cells of a row
    return corner + along * (x + std::min(width / 2, inside / 3)) + across * (y + std::min(height / 2, inside / 3));
}

SurfaceLookupGrid::SurfaceLookupGrid(const std::vector<Shape>& shapes, std::size_t most, const Find& find,
                                     const RunContext& context)
    : entries_(shapes.size()) {
    const auto number = [most](double share, std::size_t size) {
        return static_cast<std::size_t>(share * static_cast<double>(most)) / size;
    };
    std::vector<Triangle> large = index(shapes, number(kEntries, 2 * sizeof(std::uint32_t)), find, context);
    large.resize(std::min(large.size(), number(kGrids, sizeof(Grid))));
    make_grids(shapes, std::move(large), number(kCells, sizeof(Cell)), find, context);
    const auto each_side = [&](auto&& body) {
        parallel_for(2 * static_cast<std::int64_t>(grids_.size()), context, [&](std::int64_t i) {
            const Grid& grid = grids_[static_cast<std::size_t>(i / 2)];
            const auto side = static_cast<std::size_t>(i % 2);
            if (grid.first[side] != kNone) body(grid, side);
        });
    };
    each_side([&](const Grid& grid, std::size_t side) { fill(grid, side, find); });
    divide((most - std::min(most, bytes())) / sizeof(std::uint32_t));
    each_side([&](const Grid& grid, std::size_t side) { fill_parts(grid, side, find); });
}

std::vector<SurfaceLookupGrid::Triangle> SurfaceLookupGrid::index(const std::vector<Shape>& shapes, std::size_t most,
                                                                  const Find& find, const RunContext& context) {
    std::vector<std::pair<double, std::uint32_t>> by_area;
    for (std::uint32_t s = 0; s < shapes.size(); ++s)
        if (is_asked(shapes[s]) && triangle_count(shapes[s]) > 0)
            by_area.emplace_back(mean_triangle_area(shapes[s]), s);
    std::ranges::stable_sort(by_area, std::greater(), &std::pair<double, std::uint32_t>::first);
    std::vector<Triangle> large;
    for (const auto& [area, s] : by_area) {
        const std::size_t triangles = triangle_count(shapes[s]);
        if (triangles > most) continue;
        most -= triangles;
        auto& entries = entries_[s];
        entries.resize(2 * triangles);
        parallel_blocks(static_cast<std::int64_t>(entries.size()), kSidesOfBlock, context, [&, s = s](std::int64_t i) {
            entries[static_cast<std::size_t>(i)] =
                place_for_all(shapes[s], static_cast<std::uint32_t>(i / 2), i % 2 == 1, find);
        });
        for (std::uint32_t t = 0; t < triangles; ++t) {
            const bool whole = entries[entry_of(t, 0)] != kSearch && entries[entry_of(t, 1)] != kSearch;
            if (const double own = triangle_area(shapes[s], t); !whole && own > 0) large.push_back({s, t, own, {}});
        }
    }
    std::ranges::stable_sort(large, std::greater(), &Triangle::area);
    return large;
}

void SurfaceLookupGrid::make_grids(const std::vector<Shape>& shapes, std::vector<Triangle> triangles, std::size_t most,
                                   const Find& find, const RunContext& context) {
    double area = 0;
    for (Triangle& t : triangles)
        for (const std::size_t side : {0, 1}) {
            check_stop(context);
            if (entries_[t.shape][entry_of(t.triangle, side)] != kSearch ||
                !has_places(shapes[t.shape], t.triangle, side == 1, find))
                continue;
            t.sides.push_back(side);
            area += t.area;
        }
    for (const Triangle& t : triangles) {
        if (t.sides.empty()) continue;
        // Half of the cells is for small triangles, which have more than their share.
        Grid grid = make_grid(triangle_corners(shapes[t.shape], t.triangle), 2 * area / static_cast<double>(most));
        const std::uint32_t cells = grid.before(grid.rows);
        if (cells_.size() + t.sides.size() * cells > most) break;
        for (const std::size_t side : t.sides) {
            grid.first[side] = static_cast<std::uint32_t>(cells_.size());
            entries_[t.shape][entry_of(t.triangle, side)] = kGrid + static_cast<std::uint32_t>(grids_.size());
            cells_.resize(cells_.size() + cells);
        }
        grids_.push_back(grid);
    }
    grids_.shrink_to_fit();
    cells_.shrink_to_fit();
}

SurfaceLookupGrid::Grid SurfaceLookupGrid::make_grid(const std::array<Vec3, 3>& p, double cell_area) {
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

void SurfaceLookupGrid::fill(const Grid& grid, std::size_t side, const Find& find) {
    const Vec3 normal = side == 0 ? grid.normal : -grid.normal;
    std::uint32_t at = grid.first[side];
    for (std::uint32_t row = 0; row < grid.rows; ++row)
        for (std::uint32_t column = 0; column < grid.in_row(row); ++column) {
            const Found found = find(grid.middle(column, row, 1, 0), normal);
            const float parts = std::ceil(grid.size() / found.size);
            cells_[at++] = {found.place, static_cast<std::uint32_t>(std::clamp(parts, 1.0f, kMostParts))};
        }
}

void SurfaceLookupGrid::divide(std::size_t most) {
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

void SurfaceLookupGrid::fill_parts(const Grid& grid, std::size_t side, const Find& find) {
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

std::uint32_t SurfaceLookupGrid::at(const SurfacePoint& point, const Vec3& normal) const {
    if (point.shape >= entries_.size() || entries_[point.shape].empty()) return kSearch;
    const std::size_t side = point.ng.dot(normal) < 0 ? 1 : 0;
    const std::uint32_t entry = entries_[point.shape][entry_of(point.primitive, side)];
    if (entry < kGrid || entry >= kSearch) return entry;
    const Grid& grid = grids_[entry - kGrid];
    // Rounding may bring points of an edge to the other side of it.
    const auto step = [](float x, std::uint32_t steps) {
        return static_cast<std::uint32_t>(std::clamp(static_cast<int>(x), 0, static_cast<int>(steps) - 1));
    };
    const Vec3 from_corner = point.p - grid.corner;
    const float x = from_corner.dot(grid.to_column), y = from_corner.dot(grid.to_row);
    const std::uint32_t row = step(y, grid.rows), column = step(x, grid.in_row(row));
    const Cell& cell = cells_[grid.first[side] + grid.before(row) + column];
    if (cell.parts == 1) return cell.place;
    const auto part = [&](float of_grid, std::uint32_t of_cell) {
        return step((of_grid - static_cast<float>(of_cell)) * static_cast<float>(cell.parts), cell.parts);
    };
    return parts_[cell.place + part(y, row) * cell.parts + part(x, column)];
}

std::size_t SurfaceLookupGrid::bytes() const {
    std::size_t sum =
        grids_.capacity() * sizeof(Grid) + cells_.capacity() * sizeof(Cell) + parts_.capacity() * sizeof(std::uint32_t);
    for (const auto& entries : entries_) sum += entries.capacity() * sizeof(std::uint32_t);
    return sum;
}

} // namespace keyhole
