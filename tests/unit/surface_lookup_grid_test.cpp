// Cells on triangles, each with its own place.
#include "photonmap/irradiance/surface_lookup_grid.h"

#include "core/rng.h"
#include "scene/geometry.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <mutex>
#include <set>

namespace keyhole {
namespace {

/// What the search was asked; places are indices of these.
struct Asked {
    Vec3 middle, normal;
};

struct Searches {
    std::vector<Asked> asked;
    std::mutex turn;

    /// Every place is good for cells of `size` [m].
    SurfaceLookupGrid::Find find(float size) {
        return [this, size](const Vec3& middle, const Vec3& normal) -> SurfaceLookupGrid::Found {
            const std::lock_guard lock(turn);
            asked.push_back({middle, normal});
            return {static_cast<std::uint32_t>(asked.size() - 1), size};
        };
    }
};

/// A long thin triangle, a fat one that leans, and a small one.
std::vector<Shape> triangles() {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {10, 0, 0}, {0, 1, 0},    {3, 3, 5},   {9, 4, 6},
                      {4, 9, 7}, {0, 0, 9},  {0.1f, 0, 9}, {0, 0.1f, 9}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
    std::vector<Shape> shapes;
    shapes.push_back({.geometry = mesh, .material = make_diffuse(Rgb(0.5)), .emission = nullptr});
    return shapes;
}

SurfacePoint random_point(const std::vector<Shape>& shapes, std::uint32_t triangle, Rng& rng) {
    auto u = static_cast<float>(rng.next()), v = static_cast<float>(rng.next());
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    SurfacePoint s = triangle_point(std::get<TriangleMesh>(shapes[0].geometry), triangle, u, v);
    s.shape = 0;
    return s;
}

/// Points of the first two triangles, and what the grid says of them.
struct Lookups {
    int all = 0, searched = 0;
    float farthest = 0; ///< from a point to where its place was found [m]
};

Lookups look_up(const SurfaceLookupGrid& grid, const std::vector<Shape>& shapes, const Searches& searches) {
    Rng rng(1, StreamPurpose::test, 0);
    Lookups l;
    for (; l.all < 4000; ++l.all) {
        const SurfacePoint s = random_point(shapes, static_cast<std::uint32_t>(l.all % 2), rng);
        const Vec3 side = l.all % 4 < 2 ? s.ng : -s.ng;
        const std::uint32_t place = grid.at(s, side);
        if (place == SurfaceLookupGrid::kSearch) {
            ++l.searched;
            continue;
        }
        const Asked& asked = searches.asked.at(place);
        EXPECT_GT(asked.normal.dot(side), 0.999f);
        EXPECT_LT(std::abs((asked.middle - s.p).dot(s.ng)), 1e-5f) << "on the triangle";
        l.farthest = std::max(l.farthest, (asked.middle - s.p).length());
    }
    return l;
}

TEST(SurfaceLookupGrid, GivesWhatWasFoundNearbyOnTheSameSide) {
    const std::vector<Shape> shapes = triangles();
    Searches searches;
    const SurfaceLookupGrid grid(shapes, 16'000, searches.find(5), {});
    EXPECT_LE(searches.asked.size(), 600u) << "but for some that ask what sides there are";
    const Lookups found = look_up(grid, shapes, searches);
    EXPECT_EQ(found.searched, 0);
    EXPECT_LT(found.farthest, 5) << "a cell's diagonal";
}

TEST(SurfaceLookupGrid, DividesCellsThatAreTooLargeForTheirPlaces) {
    const std::vector<Shape> shapes = triangles();
    Searches searches;
    const SurfaceLookupGrid grid(shapes, 160'000, searches.find(0.15f), {});
    EXPECT_LE(grid.bytes(), 160'000);
    const Lookups found = look_up(grid, shapes, searches);
    EXPECT_EQ(found.searched, 0);
    EXPECT_LT(found.farthest, 0.15f * std::sqrt(2.0f));
}

TEST(SurfaceLookupGrid, LeavesWhatItHasNoRoomForToTheSearch) {
    const std::vector<Shape> shapes = triangles();
    Searches searches;
    const SurfaceLookupGrid grid(shapes, 16'000, searches.find(0.1f), {});
    EXPECT_LE(grid.bytes(), 16'000);
    const Lookups found = look_up(grid, shapes, searches);
    EXPECT_GT(found.searched, 0);
    EXPECT_LT(found.searched, found.all) << "but some cells are divided";
    EXPECT_LT(found.farthest, 0.1f * std::sqrt(2.0f));
}

TEST(SurfaceLookupGrid, ASmallTriangleIsACellByItself) {
    const std::vector<Shape> shapes = triangles();
    Searches searches;
    const SurfaceLookupGrid grid(shapes, 16'000, searches.find(0.2f), {});
    Rng rng(1, StreamPurpose::test, 0);
    std::set<std::uint32_t> outside, inside;
    for (int i = 0; i < 100; ++i) {
        const SurfacePoint s = random_point(shapes, 2, rng);
        outside.insert(grid.at(s, s.ng));
        inside.insert(grid.at(s, -s.ng));
    }
    ASSERT_EQ(outside.size(), 1u);
    ASSERT_EQ(inside.size(), 1u);
    EXPECT_NE(outside, inside);
    const Asked& asked = searches.asked.at(*outside.begin());
    EXPECT_NEAR((asked.middle - Vec3(0.1f / 3, 0.1f / 3, 9)).length(), 0, 1e-5f);
    EXPECT_GT(asked.normal.z, 0.999f);
}

TEST(SurfaceLookupGrid, LeavesOtherShapesAndEmptySidesToTheSearch) {
    const std::vector<Shape> shapes = triangles();
    Searches searches;
    const SurfaceLookupGrid grid(shapes, 800, searches.find(5), {}); // the largest triangle's worth
    Rng rng(1, StreamPurpose::test, 0);
    SurfacePoint s = random_point(shapes, 0, rng);
    EXPECT_EQ(grid.at(s, s.ng), SurfaceLookupGrid::kSearch);
    s.shape = SurfacePoint::kNone;
    EXPECT_EQ(grid.at(s, s.ng), SurfaceLookupGrid::kSearch);
    const SurfaceLookupGrid one_sided(shapes, 16'000,
                                      [](const Vec3&, const Vec3& n) {
                                          return SurfaceLookupGrid::Found{n.z > 0 ? 5 : SurfaceLookupGrid::kNothing, 9};
                                      },
                                      {});
    s = random_point(shapes, 0, rng);
    EXPECT_EQ(one_sided.at(s, s.ng), 5u);
    EXPECT_EQ(one_sided.at(s, -s.ng), SurfaceLookupGrid::kSearch);
    const SurfaceLookupGrid none(shapes, 32, searches.find(5), {});
    EXPECT_EQ(none.at(s, s.ng), SurfaceLookupGrid::kSearch) << "no room for cells";
}

} // namespace
} // namespace keyhole
