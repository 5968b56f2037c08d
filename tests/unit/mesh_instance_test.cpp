// Instances of meshes look, to rays and to all that asks for triangles, as meshes would that stand in their place.
#include "core/error.h"
#include "core/rng.h"
#include "methods/inspection/inspection.h"
#include "photonmap/irradiance/surface_lookup_grid.h"
#include "photonmap/surface/surface_patches.h"
#include "sampling/scene_hash.h"
#include "scene/emitters/emitters.h"
#include "scene/geometry.h"
#include "scene/load/load_mesh.h"
#include "scene/media/medium.h"
#include "scene/textures/function_texture.h"
#include "scene/warp.h"
#include "support/mesh_copies.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace keyhole {
namespace {

using test::dented_ball;
using test::instance_of;
using test::moved;
using test::random_transform;
using test::scene_of;
using test::without_instances;

std::shared_ptr<const TriangleMesh> ball(std::uint32_t columns = 24, std::uint32_t rows = 12) {
    return std::make_shared<const TriangleMesh>(dented_ball(columns, rows));
}

/// Depends on the parametrisation, so that points have one.
std::shared_ptr<const Material> textured() {
    return make_diffuse(function_texture<Rgb>([](const SurfacePoint& p) { return Rgb(0.2, p.uv.x, 0.5); }));
}

/// Objects of two meshes each, which have holes but for one, and a mesh that has no copies.
std::vector<Shape> some_copies() {
    const auto large = ball(), small = std::make_shared<const TriangleMesh>([] {
                                   TriangleMesh mesh = dented_ball(10, 6);
                                   mesh.normals.clear();
                                   transform_mesh(mesh, moved({}, 0.6, {0.2, 0.3, 0}));
                                   return mesh;
                               }());
    // Each copy has others.
    const auto holes = [](std::uint64_t copy) {
        return function_texture<double>([copy](const SurfacePoint& p) {
            return std::fmod(7 * p.uv.x + 0.3f * float(copy), 1.0f) < 0.5f ||
                           std::fmod(5 * std::abs(p.p.y), 1.0f) < 0.4f
                       ? 1.0
                       : 0.0;
        });
    };
    std::vector<Shape> shapes;
    for (std::uint64_t i = 0; i < 8; ++i) {
        const auto place = std::make_shared<const ObjectToWorld>(moved(
            random_transform(i, i % 2 == 1), 1, {1.3 * double(i % 2), 1.1 * double(i / 2 % 2), 1.2 * double(i / 4)}));
        shapes.push_back(instance_of(large, place, textured()));
        if (i > 0) shapes.back().alpha = holes(i);
        shapes.push_back(instance_of(small, place, textured()));
        if (i % 3 == 0)
            shapes.push_back(
                {.geometry = Sphere{{float(i), -1, 0}, 0.2f}, .material = textured(), .emission = nullptr});
    }
    shapes.push_back({.geometry = *large, .material = textured(), .emission = nullptr});
    return shapes;
}

void expect_same_point(const SurfacePoint& a, const SurfacePoint& b, float tolerance) {
    EXPECT_LE((a.p - b.p).length(), tolerance);
    EXPECT_LE((a.ng - b.ng).length(), tolerance);
    EXPECT_LE((a.ns - b.ns).length(), tolerance);
    EXPECT_LE((a.tangent - b.tangent).length(), tolerance);
    EXPECT_LE((a.uv - b.uv).length(), tolerance);
    EXPECT_LE(std::abs(a.dpdu - b.dpdu), tolerance * b.dpdu);
    EXPECT_LE((a.dpdv - b.dpdv).length(), tolerance * b.dpdv.length());
}

TEST(MeshInstance, HasThePointsOfTheMeshThatWouldStandThere) {
    const auto mesh = ball();
    Rng rng(1, StreamPurpose::test, 0);
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const auto place =
            std::make_shared<const ObjectToWorld>(moved(random_transform(seed, seed % 2 == 1), 3, {1, -20, 5}));
        const Shape copy = instance_of(mesh, place, textured());
        const TriangleMesh there = flattened(std::get<MeshInstance>(copy.geometry));
        for (std::uint32_t t = 0; t < there.triangles.size(); t += 7) {
            const auto [u0, u1] = rng.take<2>();
            const Vec2 at = uniform_triangle(u0, u1);
            const SurfacePoint a = triangle_point(copy, t, at.x, at.y), b = triangle_point(there, t, at.x, at.y);
            EXPECT_EQ(a.p, b.p);
            expect_same_point(a, b, 2e-4f); // edges keep digits that the mesh has lost
            EXPECT_EQ(a.primitive, t);
            EXPECT_GE(a.offset, b.offset) << "the transform is rounded, too";
            EXPECT_LE(a.offset, 2e-4f * a.p.length());
            // Outward: the ball's middle is behind it.
            EXPECT_GT(a.ng.dot(a.p - place->point({0.1f, -0.2f, 0})), 0);
            EXPECT_GT(a.ns.dot(a.ng), 0);
            // The normal is perpendicular to what lies in the surface.
            const auto corners = triangle_corners(copy, t);
            EXPECT_NEAR(a.ng.dot((corners[1] - corners[0]).normalized()), 0, 1e-4f);
            EXPECT_EQ(triangle_area(copy, t), triangle_area(there, t));
        }
    }
}

/// Normals that are those of the triangles stay that.
TEST(MeshInstance, TakesNormalsWithIt) {
    const auto mesh = ball();
    TriangleMesh faceted;
    for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t) {
        for (const std::uint32_t i : mesh->triangles[t]) {
            faceted.positions.push_back(mesh->positions[i]);
            faceted.normals.push_back(triangle_point(*mesh, t, 0.3f, 0.3f).ng);
        }
        faceted.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    const auto shared = std::make_shared<const TriangleMesh>(std::move(faceted));
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const auto place = std::make_shared<const ObjectToWorld>(random_transform(seed, seed % 2 == 1));
        const Shape copy = instance_of(shared, place, textured());
        for (std::uint32_t t = 0; t < shared->triangles.size(); ++t) {
            const SurfacePoint p = triangle_point(copy, t, 0.2f, 0.5f);
            EXPECT_LT((p.ns - p.ng).length(), 1e-5f);
        }
    }
}

TEST(MeshInstance, MeetsRaysWhereTheMeshWould) {
    std::vector<Shape> shapes = some_copies();
    const auto meshes = scene_of(without_instances(shapes)), copies = scene_of(std::move(shapes));
    ASSERT_EQ(copies->triangle_count(), meshes->triangle_count());
    Rng rng(2, StreamPurpose::test, 0);
    const Vec3 middle = (meshes->lower() + meshes->upper()) / 2, half = (meshes->upper() - meshes->lower()) / 2;
    int hits = 0, others = 0, blocked = 0;
    std::map<std::uint32_t, int> by_shape;
    for (int i = 0; i < 40'000; ++i) {
        SurfacePoint from, to;
        from.site = to.site = Site::point;
        const auto random = [&] {
            const auto [x, y, z] = rng.take<3>();
            return middle +
                   Vec3(float(2 * x - 1) * half.x, float(2 * y - 1) * half.y, float(2 * z - 1) * half.z) * 1.2f;
        };
        from.p = random();
        to.p = random();
        const Vec3 w = (to.p - from.p).normalized();
        const auto a = copies->trace(from, w), b = meshes->trace(from, w);
        blocked += copies->visible(from, to) != meshes->visible(from, to) ? 1 : 0;
        if (!a || !b || a->shape != b->shape || a->primitive != b->primitive) {
            others += a.has_value() || b.has_value() ? 1 : 0;
            continue;
        }
        ++hits;
        ++by_shape[a->shape];
        expect_same_point(*a, *b, 2e-3f); // bends of the parametrisation are within triangles
        EXPECT_LE((a->p - b->p).length(), 3e-5f * (1 + (b->p - from.p).length()));
        EXPECT_EQ(a->material, b->material);
    }
    EXPECT_GT(hits, 10'000);
    EXPECT_EQ(by_shape.size(), copies->shapes().size()) << "each is met";
    EXPECT_LT(others, 40) << "edges of triangles and holes";
    EXPECT_LT(blocked, 40);
}

TEST(MeshInstance, IsRefusedWhereItsTransformWouldLoseWhatItHolds) {
    Imath::M44d flat;
    flat[2][2] = 1e-9;
    flat[2][0] = 1;
    for (const Imath::M44d& bad :
         {flat, Imath::M44d(0.0), moved({}, std::numeric_limits<double>::quiet_NaN(), {0, 0, 0})}) {
        std::vector<Shape> shapes;
        shapes.push_back(instance_of(ball(), std::make_shared<const ObjectToWorld>(bad), textured()));
        EXPECT_THROW(scene_of(std::move(shapes)), InputError);
    }
}

TEST(MeshInstance, MayEmitOrBoundAMedium) {
    const auto place = std::make_shared<const ObjectToWorld>(moved(random_transform(5, true), 1, {0, 1, 0}));
    std::vector<Shape> shapes;
    shapes.push_back(instance_of(ball(), place, make_diffuse(Rgb(0.5))));
    shapes.back().emission = std::make_unique<SurfaceEmission>(SurfaceEmission{Rgb(2.0)});
    shapes.push_back(instance_of(ball(), std::make_shared<const ObjectToWorld>(moved({}, 1, {3, 0, 0})), nullptr));
    shapes.back().inside = std::make_shared<const Medium>(Medium{.absorption = Rgb(1.0)});
    const auto meshes = scene_of(without_instances(shapes)), copies = scene_of(std::move(shapes));
    ASSERT_EQ(copies->emitters().size(), 1u);
    EXPECT_NEAR(copies->emitter(0).power(), meshes->emitter(0).power(), 1e-9);
    SurfacePoint a, b;
    a.site = b.site = Site::point;
    for (const float y : {-0.5f, -0.2f, 0.0f}) {
        a.p = {2, y, 0.05f};
        b.p = {4, y, -0.05f};
        const double left = copies->transmittance(a, b).x;
        EXPECT_LT(left, 0.9);
        EXPECT_NEAR(left, meshes->transmittance(a, b).x, 1e-5);
    }
}

TEST(MeshInstance, HasTheSurfaceOfTheMeshThatWouldStandThere) {
    const std::vector<Shape> copies = some_copies(), meshes = without_instances(copies);
    for (std::size_t i = 0; i < copies.size(); ++i) EXPECT_EQ(surface_area(copies[i]), surface_area(meshes[i]));
    const SurfacePatches a(copies), b(meshes);
    Rng rng(4, StreamPurpose::test, 0);
    double sum = 0;
    for (int i = 0; i < 300; ++i) {
        const auto s = static_cast<std::uint32_t>(rng.next() * double(meshes.size()));
        if (triangle_count(meshes[s]) == 0) continue;
        const SurfacePoint p = triangle_point(
            meshes[s], static_cast<std::uint32_t>(rng.next() * double(triangle_count(meshes[s]))), 0.3f, 0.3f);
        const SurfaceRegion region{p.p, p.ng};
        EXPECT_EQ(a.area(region, 0.1), b.area(region, 0.1));
        EXPECT_EQ(a.obstructed(region, 0.1), b.obstructed(region, 0.1));
        sum += a.area(region, 0.1);
    }
    EXPECT_GT(sum, 0);
}

TEST(MeshInstance, HasPlacesInTheGridOfLookups) {
    const std::vector<Shape> copies = some_copies(), meshes = without_instances(copies);
    // Places are cubes of space.
    const SurfaceLookupGrid::Find find = [](const Vec3& p, const Vec3&) {
        const auto cell = [](float x) { return static_cast<std::uint32_t>(std::floor(8 * x) + 64); };
        return SurfaceLookupGrid::Found{(cell(p.x) * 128 + cell(p.y)) * 128 + cell(p.z), 0.05f};
    };
    const SurfaceLookupGrid a(copies, 4'000'000, find, {}), b(meshes, 4'000'000, find, {});
    int found = 0;
    for (std::uint32_t s = 0; s < copies.size(); ++s)
        for (std::uint32_t t = 0; t < triangle_count(copies[s]); ++t) {
            SurfacePoint p = triangle_point(copies[s], t, 0.25f, 0.3f);
            p.shape = s;
            for (const Vec3& side : {p.ng, -p.ng}) {
                EXPECT_EQ(a.at(p, side), b.at(p, side));
                found += a.at(p, side) != SurfaceLookupGrid::kSearch ? 1 : 0;
            }
        }
    EXPECT_GT(found, 1000);
}

TEST(MeshInstance, IsShownAndToldApartByWhereItStands) {
    std::vector<Shape> shapes = some_copies(), others = some_copies();
    const auto all = surface_mesh(*scene_of(without_instances(shapes)), 100'000);
    std::get<MeshInstance>(others[4].geometry).to_world =
        std::make_shared<const ObjectToWorld>(random_transform(99, false));
    const auto scene = scene_of(std::move(shapes)), same = scene_of(some_copies()), other = scene_of(std::move(others));
    const auto shown = surface_mesh(*scene, 100'000);
    EXPECT_EQ(shown.triangles, all.triangles);
    EXPECT_EQ(shown.positions, all.positions);
    EXPECT_LT(surface_mesh(*scene, 2000).triangles.size(), 3000u) << "copies are simplified, too";
    EXPECT_EQ(scene_hash(*scene), scene_hash(*same));
    EXPECT_NE(scene_hash(*scene), scene_hash(*other));
}

std::uint64_t hash_of_copy_at(double x) {
    std::vector<Shape> shapes;
    const auto place = std::make_shared<const ObjectToWorld>(moved({}, 1, {x, 0, 0}));
    shapes.push_back(instance_of(ball(), place, make_diffuse(Rgb(0.5))));
    return scene_hash(*scene_of(std::move(shapes)));
}

TEST(MeshInstance, HasTheHashOfItsPlaceInFloats) {
    EXPECT_EQ(hash_of_copy_at(1), hash_of_copy_at(1 + 1e-15)) << "last bits of doubles are the library's affair";
    EXPECT_NE(hash_of_copy_at(1), hash_of_copy_at(1 + 1e-6));
}

/// Blades whose feet are one corner in cells that are large enough to be few.
std::shared_ptr<const TriangleMesh> grass() {
    TriangleMesh mesh;
    Rng rng(5, StreamPurpose::test, 0);
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const auto [x, y] = rng.take<2>();
        const Vec3 foot(float(x), float(y), 0);
        for (const Vec3& p : {foot, foot + Vec3(1e-6f, 0, 0), foot + Vec3(0, 0, 0.1f)}) mesh.positions.push_back(p);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return std::make_shared<const TriangleMesh>(std::move(mesh));
}

TEST(MeshInstance, IsShownHoweverManyThereAre) {
    for (const auto& mesh : {ball(), grass()})
        for (const int copies : {1, 30, 800}) {
            std::vector<Shape> shapes;
            for (int i = 0; i < copies; ++i)
                shapes.push_back(instance_of(mesh, std::make_shared<const ObjectToWorld>(moved({}, 1, {2.0 * i, 0, 0})),
                                             textured()));
            constexpr std::size_t kMost = 1000;
            const SurfaceMesh shown = surface_mesh(*scene_of(std::move(shapes)), kMost);
            std::set<int> seen;
            for (const auto& triangle : shown.triangles)
                seen.insert(int(std::lround(shown.positions[triangle[0]].x / 2 - 0.2f)));
            EXPECT_EQ(seen.size(), std::size_t(copies));
            EXPECT_LE(shown.triangles.size(), 2 * kMost + std::size_t(copies));
        }
}

/// Glass of flat faces lets light straight through, that of a ball none; a pane all.
TEST(MeshInstance, IsClearGlassWhereTheMeshIs) {
    TriangleMesh flat = dented_ball(12, 8);
    flat.normals.clear();
    const auto faceted = std::make_shared<const TriangleMesh>(std::move(flat));
    std::vector<Shape> shapes;
    for (std::uint64_t i = 0; i < 9; ++i) {
        const auto place = std::make_shared<const ObjectToWorld>(
            moved(random_transform(i, i % 2 == 1), 1, {1.5 * double(i % 3), 1.5 * double(i / 3), 0}));
        shapes.push_back(instance_of(i % 3 == 0 ? ball() : faceted, place,
                                     i % 3 == 2 ? make_thin_dielectric(1.5) : make_glass(1.5)));
    }
    const auto meshes = scene_of(without_instances(shapes)), copies = scene_of(std::move(shapes));
    Rng rng(6, StreamPurpose::test, 0);
    int met = 0, others = 0;
    for (int i = 0; i < 10'000; ++i) {
        const auto [x, y, u, v] = rng.take<4>();
        SurfacePoint from;
        from.site = Site::point;
        from.p = {float(5 * x - 1), float(5 * y - 1), -3};
        const Vec3 w = Vec3(float(u - 0.5), float(v - 0.5), 1).normalized();
        const bool clear = meshes->meets_clear_glass(from, w);
        met += clear ? 1 : 0;
        others += clear != copies->meets_clear_glass(from, w) ? 1 : 0;
    }
    EXPECT_GT(met, 500);
    EXPECT_LT(met, 9000);
    EXPECT_LT(others, 5) << "edges of triangles";
}

TEST(MeshInstance, CostsLittleHoweverManyThereAre) {
    const auto mesh = ball(40, 20);
    std::vector<Shape> shapes;
    for (int i = 0; i < 10'000; ++i)
        shapes.push_back(instance_of(mesh,
                                     std::make_shared<const ObjectToWorld>(
                                         moved(random_transform(7, false), 1, {double(i % 100), double(i / 100), 0})),
                                     textured()));
    const auto scene = scene_of(std::move(shapes));
    EXPECT_GT(scene->triangle_count(), 15'000'000u);
    EXPECT_LT(geometry_bytes(scene->shapes()), 5'000'000u);
    EXPECT_LT(scene->accelerator_bytes(), 20'000'000u);
    EXPECT_EQ(held_meshes(scene->shapes()).size(), 1u);
}

} // namespace
} // namespace keyhole
