// How far from where they should be points of instances may lie, and what that is to those who look for surfaces.
#include "core/rng.h"
#include "gather/direct_irradiance_cache.h"
#include "scene/geometry.h"
#include "scene/warp.h"
#include "support/mesh_copies.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using test::dented_ball;
using test::instance_of;
using test::moved;
using test::random_transform;
using test::scene_of;

/// A ball about `at`, where its object has it at `in_object`.
Shape ball_at(const Vec3& at, const Vec3& in_object, const Imath::M44d& linear = {}) {
    TriangleMesh mesh = dented_ball(16, 8);
    transform_mesh(mesh, moved({}, 1, Imath::V3d(in_object)));
    const Imath::V3d origin = Imath::V3d(at) - Imath::V3d(in_object) * linear;
    return instance_of(std::make_shared<const TriangleMesh>(std::move(mesh)),
                       std::make_shared<const ObjectToWorld>(moved(linear, 1, origin)), make_diffuse(Rgb(0.5)));
}

TEST(RoundingOfInstances, IsBounded) {
    std::vector<Shape> shapes;
    shapes.push_back(ball_at({3, 2, 5}, {4e4f, -2e4f, 1e4f}));
    shapes.push_back(ball_at({-200, 100, 40}, {0, 0, 0}, random_transform(3, true)));
    shapes.push_back(ball_at({7, 2, 5}, {10, 3, -8}, random_transform(4, false)));
    const auto scene = scene_of(std::move(shapes));
    for (const Shape& shape : scene->shapes())
        for (std::uint32_t t = 0; t < triangle_count(shape); ++t) {
            const SurfacePoint p = triangle_point(shape, t, 0.3f, 0.3f);
            EXPECT_GE(scene->rounding_along(p.ng, p.p) * 1.001f, p.offset) << p.p;
        }
}

TEST(RoundingOfInstances, IsSmallNearTheOriginOfTheWorldWhereverOthersStand) {
    std::vector<Shape> shapes;
    shapes.push_back(ball_at({1, 2, 3}, {0, 0, 0}));
    shapes.push_back(ball_at({1e5f, 0, 0}, {0, 0, 0}));
    const auto scene = scene_of(std::move(shapes));
    EXPECT_LT(scene->instance_rounding({1, 2, 3}), 2e-5f);
    EXPECT_GT(scene->instance_rounding({1e5f, 0, 0}), 0.1f);
}

/// Points on triangles, and rays that leave them in all directions, many along the surface.
int own_surfaces_met(const Scene& scene, std::uint32_t shape, int rays) {
    Rng rng(3, StreamPurpose::test, shape);
    int met = 0;
    for (int i = 0; i < rays; ++i) {
        const auto [u0, u1, u2, u3, u4] = rng.take<5>();
        const auto t = static_cast<std::uint32_t>(u0 * double(triangle_count(scene.shapes()[shape])));
        const Vec2 at = uniform_triangle(u1, u2);
        SurfacePoint from = triangle_point(scene.shapes()[shape], t, at.x, at.y);
        from.shape = shape;
        const Frame frame(from.ng);
        const double height = (u3 < 0.5 ? -1 : 1) * std::pow(std::abs(2 * u3 - 1), 4), phi = 2 * kPi * u4,
                     r = std::sqrt(1 - height * height);
        const Vec3 w =
            frame.to_world(Vec3(float(r * std::cos(phi)), float(r * std::sin(phi)), float(height))).normalized();
        const auto hit = scene.trace(from, w);
        met += hit && hit->shape == shape && hit->primitive == t ? 1 : 0;
    }
    return met;
}

TEST(MeshInstance, IsNotMetByRaysThatLeaveIt) {
    const auto mesh = std::make_shared<const TriangleMesh>(dented_ball(24, 12));
    std::vector<Shape> shapes;
    // Large and far, small and far, and in a place that the object's own space has far from its origin.
    const std::vector<std::pair<double, Imath::V3d>> places{
        {1, {0, 0, 0}}, {1000, {0, 0, 0}}, {1, {2000, -3000, 1500}}, {1000, {9e4, 5e4, -2e4}}, {1e-3, {3, 4, 5}}};
    for (const auto& [scale, by] : places)
        for (std::uint64_t seed = 0; seed < 6; ++seed)
            shapes.push_back(instance_of(
                mesh,
                std::make_shared<const ObjectToWorld>(moved(random_transform(seed + 100, seed % 2 == 0), scale, by)),
                make_diffuse(Rgb(0.5))));
    auto far = *mesh;
    transform_mesh(far, moved({}, 1, {500, 200, 300}));
    for (std::uint64_t seed = 0; seed < 6; ++seed)
        shapes.push_back(
            instance_of(std::make_shared<const TriangleMesh>(far),
                        std::make_shared<const ObjectToWorld>(moved(random_transform(seed, false), 1, {0, 0, 0})),
                        make_diffuse(Rgb(0.5))));
    for (Shape& shape : shapes) {
        const Imath::M44d place = std::get<MeshInstance>(shape.geometry).to_world->matrix();
        std::vector<Shape> alone;
        alone.push_back(std::move(shape));
        EXPECT_EQ(own_surfaces_met(*scene_of(std::move(alone)), 0, 20'000), 0) << place;
    }
}

/// Triangles that would be lines once moved have normals all the same.
TEST(MeshInstance, HasNormalsFarAway) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1e-4f, 0}};
    mesh.triangles = {{0, 1, 2}};
    const auto place = std::make_shared<const ObjectToWorld>(moved({}, 1, {1e4, 1e4, 1e4}));
    const Shape copy = instance_of(std::make_shared<const TriangleMesh>(mesh), place, make_diffuse(Rgb(0.5)));
    EXPECT_EQ(triangle_point(copy, 0, 0.3f, 0.3f).ng, Vec3(0, 0, 1));
    EXPECT_NEAR(triangle_point(copy, 0, 0.3f, 0.3f).dpdu, 1, 1e-6);
}

/// A floor half a millimetre below a board that shines: what copies elsewhere are rounded by must not take those who
/// look for the floor beyond the board.
TEST(RoundingOfInstances, LeavesNarrowGapsThatHaveLight) {
    Imath::M44d sheared;
    sheared[1][0] = 12;
    ASSERT_TRUE(ObjectToWorld(sheared).rounds_little());
    ASSERT_GT(ObjectToWorld(sheared).relative_rounding(), 1.5e-5f);
    test::SceneMaker m;
    const auto grey = make_diffuse(Rgb(0.5));
    m.rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, grey);
    m.rectangle({-1, 0.0005f, -1}, {2, 0, 0}, {0, 0, 2}, grey, Rgb(1.0));
    m.shape(ball_at({3, 0, 0}, {0, 0, 0}, sheared));
    const auto scene = m.build();
    std::vector<Photon> places;
    for (float x = 0.3f; x < 1; x += 0.1f)
        places.emplace_back(Vec3(x, 0, 0.3f), Vec3(0, 1, 0), Vec3(0, 1, 0), Rgb(1.0));
    const DirectIrradianceCache cache(*scene, places, kMostFaces, 1, {});
    for (std::uint32_t i = 0; i < places.size(); ++i)
        EXPECT_NEAR(cache.direct(i, places[i].position())->y, kPi, 0.1) << "its surface was not found";
}

} // namespace
} // namespace keyhole
