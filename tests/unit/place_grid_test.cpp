// Cells on triangles, each with its own place.
#include "photonmap/place_grid.h"

#include "core/rng.h"
#include "scene/geometry.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <mutex>

namespace keyhole {
namespace {

/// What the search was asked; places are indices of these.
struct Asked {
    Vec3 middle, normal;
    float size;
};

struct Searches {
    std::vector<Asked> asked;
    std::mutex turn;

    PlaceGrid::Find find() {
        return [this](const Vec3& middle, const Vec3& normal, float size) {
            const std::lock_guard lock(turn);
            asked.push_back({middle, normal, size});
            return static_cast<std::uint32_t>(asked.size() - 1);
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

TEST(PlaceGrid, GivesWhatWasFoundNearbyOnTheSameSide) {
    const std::vector<Shape> shapes = triangles();
    Searches searches;
    const PlaceGrid grid(shapes, 2000, searches.find());
    EXPECT_GT(searches.asked.size(), 1000u);
    EXPECT_LE(searches.asked.size(), 2100u) << "but for some that ask what sides there are";
    EXPECT_LE(grid.bytes(), 2000 * PlaceGrid::bytes_per_cell());
    Rng rng(1, StreamPurpose::test, 0);
    for (int i = 0; i < 4000; ++i) {
        const SurfacePoint s = random_point(shapes, static_cast<std::uint32_t>(i % 2), rng);
        const Vec3 side = i % 4 < 2 ? s.ng : -s.ng;
        const std::uint32_t place = grid.at(s, side);
        ASSERT_LT(place, searches.asked.size());
        const Asked& asked = searches.asked[place];
        EXPECT_GT(asked.normal.dot(side), 0.999f);
        EXPECT_LT((asked.middle - s.p).length(), 1.5f * asked.size) << "at " << s.p;
        EXPECT_LT(std::abs((asked.middle - s.p).dot(s.ng)), 1e-5f) << "on the triangle";
    }
}

TEST(PlaceGrid, LeavesSmallTrianglesAndOtherShapesToTheSearch) {
    const std::vector<Shape> shapes = triangles();
    Searches searches;
    const PlaceGrid grid(shapes, 2000, searches.find());
    Rng rng(1, StreamPurpose::test, 0);
    SurfacePoint s = random_point(shapes, 2, rng);
    EXPECT_EQ(grid.at(s, s.ng), PlaceGrid::kSearch);
    s.shape = SurfacePoint::kNone;
    EXPECT_EQ(grid.at(s, s.ng), PlaceGrid::kSearch);
    const PlaceGrid one_sided(shapes, 2000,
                              [](const Vec3&, const Vec3& n, float) { return n.z > 0 ? 5 : PlaceGrid::kNothing; });
    s = random_point(shapes, 0, rng);
    EXPECT_EQ(one_sided.at(s, s.ng), 5u);
    EXPECT_EQ(one_sided.at(s, -s.ng), PlaceGrid::kSearch);
    const PlaceGrid none(shapes, 4, searches.find());
    s = random_point(shapes, 0, rng);
    EXPECT_EQ(none.at(s, s.ng), PlaceGrid::kSearch) << "no room for cells";
}

} // namespace
} // namespace keyhole
