#include "core/statistics.h"
#include "photon_support.h"
#include "photonmap/surface/disc_area.h"
#include "photonmap/surface/surface_patches.h"
#include "scene/ray_counter.h"
#include "scene/warp.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using namespace photon_test;
using Imath::V2d;

const Vec3 kUp(0, 0, 1);

/// Part of a uniform sample that fulfils a test, times the whole.
template <class Test> RunningStats monte_carlo(int n, double whole, Rng& rng, Test&& test) {
    RunningStats stats;
    for (int i = 0; i < n; ++i) {
        const double u = rng.next(), v = rng.next();
        stats.add(test(u, v) ? whole : 0.0);
    }
    return stats;
}

TEST(DiscTriangleArea, AgreesWithMonteCarlo) {
    Rng rng = make_rng(0);
    const auto coordinate = [&] { return 4 * rng.next() - 2; };
    for (int i = 0; i < 200; ++i) {
        const V2d a(coordinate(), coordinate()), b(coordinate(), coordinate()), c(coordinate(), coordinate());
        const double r = 0.2 + 1.5 * rng.next(), area = std::abs((b - a).cross(c - a)) / 2;
        const RunningStats truth = monte_carlo(20'000, area, rng, [&](double u, double v) {
            const Vec2 w = uniform_triangle(u, v);
            return (a + (b - a) * w.x + (c - a) * w.y).length() <= r;
        });
        ASSERT_LE(std::abs(disc_triangle_area(a, b, c, r) - truth.mean()),
                  test::most_errors(200) * truth.standard_error() + 1e-9)
            << i;
    }
}

TEST(DiscTriangleArea, IsExactInClosedCases) {
    const V2d a(-9, -9), b(9, -9), c(0, 20);
    EXPECT_DOUBLE_EQ(disc_triangle_area(a, b, c, 1), kPi);
    EXPECT_DOUBLE_EQ(disc_triangle_area(c, b, a, 1), kPi);
    EXPECT_DOUBLE_EQ(disc_triangle_area({0, 0}, {1, 0}, {0, 1}, 2), 0.5);
    EXPECT_NEAR(disc_triangle_area({0, 0}, {9, 0}, {0, 9}, 1), kPi / 4, 1e-14);
    EXPECT_NEAR(disc_triangle_area({0, 0}, {9, 0}, {9, 9}, 1), kPi / 8, 1e-14);
    EXPECT_NEAR(disc_triangle_area({-9, 0}, {9, 0}, {0, 9}, 1), kPi / 2, 1e-14);
    EXPECT_NEAR(disc_triangle_area({2, 2}, {3, 2}, {2, 3}, 1), 0, 1e-14);
    EXPECT_EQ(disc_triangle_area({0, 0}, {1, 1}, {2, 2}, 1), 0);
}

TEST(SurfacePatches, SumsNeighboursToTheWhole) {
    std::vector<Shape> shapes;
    shapes.push_back(shape_of(kUnitSquare, 17));
    const SurfacePatches patches(shapes);
    EXPECT_NEAR(patches.area({Vec3(0.5f, 0.43f, 0), kUp}, 0.3), kPi * 0.09, 1e-7);
    EXPECT_NEAR(patches.area({Vec3(0.5f, 0.43f, 0), -kUp}, 0.3), kPi * 0.09, 1e-7);
    EXPECT_NEAR(patches.area({Vec3(0, 0.5f, 0), kUp}, 0.3), kPi * 0.045, 1e-7);
    EXPECT_NEAR(patches.area({Vec3(0, 0, 0), kUp}, 0.3), kPi * 0.0225, 1e-7);
    EXPECT_NEAR(patches.area({Vec3(0.5f, 0.5f, 0), kUp}, 5), 1, 1e-6);
    EXPECT_EQ(patches.area({Vec3(0.5f, 0.5f, 0.5f), kUp}, 0.3), 0);
    EXPECT_EQ(patches.area({Vec3(0.5f, 0.5f, 0), Vec3(1, 0, 0)}, 0.3), 0);
}

TEST(SurfacePatches, MeasuresTiltedSurfacesLikeTheSearchDoes) {
    // A roof whose halves are tilted by 20 degrees, seen from a point of its left half near the ridge.
    const auto height = static_cast<float>(std::tan(20 * kPi / 180));
    const Rectangle halves[] = {{{-1, -1, 0}, {1, 0, height}, {0, 2, 0}},
                                {{0, -1, height}, {1, 0, -height}, {0, 2, 0}}};
    std::vector<Shape> shapes;
    for (const Rectangle& half : halves) shapes.push_back(shape_of(half, 4));
    const SurfacePatches patches(shapes);
    for (const Vec3& normal : {halves[0].normal(), kUp}) {
        const SurfaceRegion region{halves[0].at(0.97, 0.5), normal};
        for (const double r : {0.05, 0.2, 0.8}) {
            Rng rng = make_rng(0);
            double mean = 0, variance = 0;
            for (const Rectangle& half : halves) {
                const RunningStats s = monte_carlo(400'000, half.area(), rng, [&](double u, double v) {
                    return region.distance2(half.at(u, v)) <= r * r && region.accepts(half.normal());
                });
                mean += s.mean();
                variance += s.standard_error() * s.standard_error();
            }
            EXPECT_NEAR(patches.area(region, r), mean, test::most_errors(6) * std::sqrt(variance)) << r;
        }
    }
}

TEST(SurfacePatches, MeasuresTheCapOfASphere) {
    std::vector<Shape> shapes(1);
    shapes[0].geometry = Sphere{Vec3(0), 2, true};
    const SurfacePatches patches(shapes);
    const SurfaceRegion region{Vec3(0, 0, 2), -kUp};
    for (const double r : {0.1, 0.5, 3.0}) {
        Rng rng = make_rng(0);
        const RunningStats truth = monte_carlo(2'000'000, 16 * kPi, rng, [&](double u, double v) {
            const Vec3 out = uniform_sphere(u, v);
            return region.distance2(out * 2.0f) <= r * r && region.accepts(-out);
        });
        EXPECT_TRUE(test::has_mean(truth, patches.area(region, r), 3)) << r;
    }
    EXPECT_NEAR(patches.area(region, 0.001), kPi * 1e-6, 1e-10);
}

TEST(SurfacePatches, HoldsDoubledSurfacesToTheDisc) {
    std::vector<Shape> shapes;
    for (int i = 0; i < 2; ++i) shapes.push_back(shape_of(kUnitSquare));
    EXPECT_NEAR(SurfacePatches(shapes).area({Vec3(0.5f, 0.5f, 0), kUp}, 0.3), kPi * 0.09, 1e-7);
}

TEST(SurfacePatches, LeavesOutWhatHoldsNoPhotons) {
    std::vector<Shape> shapes;
    shapes.push_back(shape_of(kUnitSquare));
    shapes[0].material = make_mirror(Rgb(1.0));
    EXPECT_EQ(SurfacePatches(shapes).area({Vec3(0.5f, 0.5f, 0), kUp}, 0.3), 0);
}

/// The unit square, cut so finely that exact sums would take thousands of triangles.
std::unique_ptr<Scene> fine_square() {
    SceneDescription d;
    d.shapes.push_back(shape_of(kUnitSquare, 150));
    d.shapes.back().material = make_diffuse(Rgb(0.5));
    d.window.width = d.window.height = 8;
    return std::make_unique<Scene>(std::move(d));
}

TEST(SurfacePatches, MeasuresFineMeshesByRays) {
    const auto scene = fine_square();
    const SurfacePatches patches(*scene);
    ASSERT_EQ(patches.area({Vec3(0.5f, 0.43f, 0), kUp}, 0.3), kPi * 0.09) << "away from edges the area is the disc's";
    const double disc = kPi * 0.09;
    EXPECT_NEAR(patches.area({Vec3(0, 0.5f, 0), kUp}, 0.3), disc / 2, 0.04 * disc);
    EXPECT_NEAR(patches.area({Vec3(0, 0, 0), -kUp}, 0.3), disc / 4, 0.04 * disc);
    EXPECT_EQ(patches.area({Vec3(0.5f, 0.5f, 0.5f), kUp}, 0.3), 0);
    EXPECT_EQ(patches.area({Vec3(0.5f, 0.5f, 0), Vec3(1, 0, 0)}, 0.3), 0);
    // On the mean over places near an edge the error of single regions is gone.
    std::vector<Shape> coarse;
    coarse.push_back(shape_of(kUnitSquare));
    const SurfacePatches exact(coarse);
    Rng rng = make_rng(0);
    RunningStats error;
    for (int i = 0; i < 2000; ++i) {
        const double x = 0.1 * rng.next(), y = rng.next();
        const SurfaceRegion region{kUnitSquare.at(x, y), kUp};
        error.add((patches.area(region, 0.1) - exact.area(region, 0.1)) / (kPi * 0.01));
    }
    EXPECT_LT(std::abs(error.mean()), 0.01);
    EXPECT_LT(std::sqrt(error.variance()), 0.04);
}

TEST(SurfacePatches, CostsTheSameHoweverFineTheMeshIs) {
    const auto scene = fine_square();
    const SurfacePatches patches(*scene);
    const std::uint64_t before = rays_traced();
    for (int i = 0; i < 100; ++i) patches.area({Vec3(0.5f, 0.01f * static_cast<float>(i), 0), kUp}, 0.3);
    EXPECT_GT(rays_traced(), before) << "thousands of triangles were added up one by one";
    EXPECT_LE(rays_traced(), before + 100 * 80);
}

/// Shapes so fine that areas on them are measured by rays.
std::unique_ptr<Scene> scene_of(std::vector<Shape> shapes) {
    SceneDescription d;
    d.shapes = std::move(shapes);
    for (Shape& shape : d.shapes)
        if (shape.material == nullptr) shape.material = make_diffuse(Rgb(0.5));
    d.window.width = d.window.height = 8;
    return std::make_unique<Scene>(std::move(d));
}

/// The density that photons of density 1 on a surface seem to have in regions about places of it, on the mean: their
/// number, which is `area(r)`, over the area that rays find.
template <class Place> RunningStats densities(const Scene& scene, double area, double r, const Place& place) {
    const SurfacePatches patches(scene);
    Rng rng = make_rng(3);
    RunningStats stats;
    for (int i = 0; i < 400; ++i) stats.add(area / patches.area({place(rng.next()), kUp}, r));
    return stats;
}

TEST(SurfacePatches, MeasuresNarrowSurfacesWithoutBias) {
    // A strip a twentieth as wide as the region: where rays were few, most of them would miss it, and the mean of the
    // reciprocal would be far above that of the area.
    constexpr double kWidth = 0.01, kReach = 0.1;
    std::vector<Shape> shapes;
    shapes.push_back(shape_of({{0, 0, 0}, {1, 0, 0}, {0, kWidth, 0}}, 200));
    const auto scene = scene_of(std::move(shapes));
    const RunningStats found = densities(*scene, 2 * kReach * kWidth, kReach,
                                         [](double u) { return Vec3(static_cast<float>(0.2 + 0.6 * u), 0.005f, 0); });
    EXPECT_NEAR(found.mean(), 1, 0.06);
}

TEST(SurfacePatches, CountsOneSideOfAThinSolid) {
    // The lower side of a slat lies in the region as well, but photons that lie there face away.
    constexpr float kWidth = 0.02f, kThick = 0.004f;
    std::vector<Shape> shapes;
    shapes.push_back(shape_of({{0, 0, 0}, {1, 0, 0}, {0, kWidth, 0}}, 200));
    auto& mesh = std::get<TriangleMesh>(shapes[0].geometry);
    const Shape below = shape_of({{0, kWidth, -kThick}, {1, 0, 0}, {0, -kWidth, 0}}, 200);
    const auto& other = std::get<TriangleMesh>(below.geometry);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    const auto scene = scene_of(std::move(shapes));
    const RunningStats found = densities(*scene, 0.2 * static_cast<double>(kWidth), 0.1,
                                         [](double u) { return Vec3(static_cast<float>(0.2 + 0.6 * u), 0.01f, 0); });
    EXPECT_NEAR(found.mean(), 1, 0.06);
}

/// One shape, or a shape for each side.
TEST(SurfacePatches, CountsOneSideOfABoard) {
    const MaterialPtr white = make_diffuse(Rgb(0.5));
    for (const bool whole : {true, false}) {
        test::SceneMaker m;
        if (whole)
            m.box({0, 0, -0.002f}, {1, 0.04f, 0}, white);
        else
            m.rectangle({0, 0, 0}, {1, 0, 0}, {0, 0.04f, 0}, white)
                .rectangle({0, 0, -0.002f}, {0, 0.04f, 0}, {1, 0, 0}, white);
        const auto scene = m.camera({0, 0, 1}, {0, 0.1f, 0}, 40).window(8, 8).build();
        const SurfacePatches patches(*scene);
        const double r = 0.1, half = 0.02;
        const double strip = 2 * (half * std::sqrt(r * r - half * half) + r * r * std::asin(half / r));
        EXPECT_NEAR(patches.area({Vec3(0.5f, 0.02f, 0), kUp}, r), strip, 0.06 * strip);
        EXPECT_NEAR(patches.area({Vec3(0.5f, 0.02f, -0.002f), -kUp}, r), strip, 0.06 * strip);
        EXPECT_NEAR(patches.area({Vec3(0.5f, 0.02f, 0), kUp}, 0.01), kPi * 1e-4, 1e-9) << "away from edges";
    }
}

/// A box on a floor, and a floor whose triangles are wound either way.
TEST(SurfacePatches, AddsUpWhatEnclosesNoSolid) {
    const MaterialPtr white = make_diffuse(Rgb(0.5));
    test::SceneMaker m;
    m.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, white).rectangle({1, 0, 0}, {0, 1, 0}, {1, 0, 0}, white);
    m.box({0.3f, 0.3f, 0}, {0.6f, 0.6f, 0.5f}, white).camera({0, 0, 1}, {0, 0.1f, 0}, 40).window(8, 8);
    const auto scene = m.build();
    const SurfacePatches patches(*scene);
    const std::uint64_t before = rays_traced();
    EXPECT_NEAR(patches.area({Vec3(0.28f, 0.45f, 0), kUp}, 0.1), kPi * 0.01, 1e-6);
    EXPECT_NEAR(patches.area({Vec3(0.99f, 0.5f, 0), kUp}, 0.1), kPi * 0.01, 1e-6);
    EXPECT_EQ(rays_traced(), before);
}

/// The area that photons can lie on of a square about a region, over that of its disc.
double share_that_holds(const MaterialPtr& material, double opacity) {
    test::SceneMaker m;
    m.rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, material).alpha(opacity);
    m.camera({0, 0, 1}, {0, 0.1f, 0}, 40).window(8, 8);
    const auto scene = m.build();
    const SurfacePatches patches(*scene);
    RunningStats shares;
    for (int i = 0; i < 200; ++i)
        shares.add(patches.area({Vec3(0.004f * static_cast<float>(i) - 0.4f, 0, 0), kUp}, 0.1) / (kPi * 0.01));
    return shares.mean();
}

TEST(SurfacePatches, CountsPlacesThatHoldPhotons) {
    const MaterialPtr white = make_diffuse(Rgb(0.5)), glass = make_glass(1.5);
    const auto mix = [](const MaterialPtr& a, const MaterialPtr& b, double amount) {
        return make_mix(a, b, constant_texture(amount));
    };
    EXPECT_NEAR(share_that_holds(white, 1), 1, 1e-6);
    EXPECT_NEAR(share_that_holds(white, 0.4), 0.4, 0.02);
    EXPECT_NEAR(share_that_holds(mix(white, glass, 0.3), 1), 0.7, 1e-6);
    EXPECT_NEAR(share_that_holds(mix(white, mix(glass, white, 0.25), 0.4), 1), 0.7, 1e-6);
    EXPECT_NEAR(share_that_holds(mix(white, make_diffuse(Rgb(0.1)), 0.4), 1), 1, 1e-6);
    EXPECT_NEAR(share_that_holds(mix(white, glass, 0.5), 0.6), 0.3, 0.02);
    const SurfaceDefaults dim{constant_texture(0.5)};
    EXPECT_NEAR(share_that_holds(with_surface(mix(white, glass, 0.3), dim), 1), 0.7, 1e-6);
}

TEST(SurfacePatches, LooksThroughWhatHoldsNoPhotons) {
    // Glass just above the edge of a floor, and a second floor just below it: photons of both lie in the region.
    std::vector<Shape> shapes;
    shapes.push_back(shape_of({{0, 0, 0}, {0.5f, 0, 0}, {0, 1, 0}}, 100));
    shapes.push_back(shape_of({{0, 0, 0.004f}, {0.6f, 0, 0}, {0, 1, 0}}, 100));
    shapes.back().material = make_glass(1.5);
    shapes.push_back(shape_of({{0.45f, 0, -0.004f}, {0.04f, 0, 0}, {0, 1, 0}}, 100));
    const auto scene = scene_of(std::move(shapes));
    const SurfacePatches patches(*scene);
    const double r = 0.1, disc = kPi * r * r, strip = 0.04 * 2 * r;
    EXPECT_NEAR(patches.area({Vec3(0.5f, 0.5f, 0), kUp}, r), disc / 2 + strip, 0.08 * disc);
}

TEST(SurfacePatches, SeesAWallOnAFineFloor) {
    SceneDescription d;
    d.shapes.push_back(shape_of(kUnitSquare, 150));
    d.shapes.push_back(shape_of({{0.5f, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 150));
    for (Shape& shape : d.shapes) shape.material = make_diffuse(Rgb(0.5));
    d.window.width = d.window.height = 8;
    const Scene scene(std::move(d));
    const SurfacePatches patches(scene);
    EXPECT_TRUE(patches.obstructed({Vec3(0.4f, 0.5f, 0), kUp}, 0.2));
    EXPECT_FALSE(patches.obstructed({Vec3(0.2f, 0.5f, 0), kUp}, 0.2));
}

TEST(SurfacePatches, GlassPartsWhatItStandsOn) {
    std::vector<Shape> shapes;
    shapes.push_back(shape_of(kUnitSquare, 1));
    shapes.push_back(shape_of({{0.5f, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1));
    shapes.back().material = make_glass(1.5);
    const auto scene = scene_of(std::move(shapes));
    const SurfacePatches patches(*scene);
    const SurfaceRegion near{Vec3(0.45f, 0.5f, 0), kUp}, away{Vec3(0.2f, 0.5f, 0), kUp};
    constexpr double r = 0.1, disc = kPi * r * r;
    EXPECT_TRUE(patches.obstructed(near, r));
    EXPECT_FALSE(patches.obstructed(away, r));
    EXPECT_NEAR(patches.area(near, r), disc, 1e-6) << "it is no surface of photons";
    const double cut = disc_triangle_area({-1, -10}, {0.05, -10}, {0.05, 10}, r) +
                       disc_triangle_area({-1, -10}, {0.05, 10}, {-1, 10}, r);
    EXPECT_NEAR(patches.area_in_sight(near, r, 0.01f), cut, 0.05 * disc);
}

} // namespace
} // namespace keyhole
