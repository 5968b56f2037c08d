#include "photonmap/importance/importance_map.h"

#include "core/statistics.h"
#include "photon_support.h"
#include "sampling/paths/measure.h"
#include "sampling/paths/walk.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using namespace photon_test;

const Vec3 kUp(0, 0, 1);
const Rgb kReflectance(0.5, 0.25, 0.8);

SurfacePoint point_at(const Vec3& p, const Vec3& ns = kUp) {
    SurfacePoint s;
    s.p = p;
    s.ng = kUp;
    s.ns = ns;
    return s;
}

Bsdf diffuse_at(const SurfacePoint& s) { return {s, DiffuseBsdf{kReflectance}}; }

/// Importons of importance 2 on the upper side of the unit square, n per square metre.
ImportanceMap uniform_map(int n, std::uint64_t seed, const SurfacePatches* patches, int k = 20) {
    Rng rng = make_rng(seed);
    std::vector<Photon> importons;
    throw_photons(kUnitSquare, n, rng, importons, Rgb(2.0));
    return {std::move(importons), {.k = k, .max_radius = 0.5f, .patches = patches}};
}

TEST(ImportanceMap, HasTheRightReciprocalInTheMiddleAndAtTheEdge) {
    constexpr int n = 400;
    std::vector<Shape> shapes;
    shapes.push_back(shape_of(kUnitSquare, 2));
    const SurfacePatches patches(shapes);
    const Vec3 to_light = Vec3(1, 2, 2).normalized();
    for (const Vec3& p : {Vec3(0.5f, 0.5f, 0), Vec3(0, 0.3f, 0), Vec3(1, 0, 0)}) {
        RunningStats reciprocal;
        for (std::uint64_t seed = 0; seed < 1500; ++seed) {
            const SurfacePoint d2 = point_at(p);
            const auto e = uniform_map(n, seed, &patches).importance(d2, diffuse_at(d2), to_light);
            ASSERT_EQ(e.importons, 20);
            reciprocal.add(1 / e.value.x);
        }
        const double expected = kPi / (kReflectance.x * 2 * (n + 1));
        EXPECT_TRUE(test::has_mean(reciprocal, expected, 3));
        EXPECT_LT(reciprocal.standard_error(), 0.01 * expected);
    }
}

TEST(ImportanceMap, KnowsTheSideOfTheLight) {
    const ImportanceMap map = uniform_map(400, 0, nullptr);
    const SurfacePoint d2 = point_at(Vec3(0.5f, 0.5f, 0));
    EXPECT_EQ(map.importance(d2, diffuse_at(d2), kUp).importons, 20);
    const auto below = map.importance(d2, diffuse_at(d2), -kUp);
    EXPECT_EQ(below.importons, 0);
    EXPECT_TRUE(is_black(below.value));
}

TEST(ImportanceMap, CarriesTheShadingNormalFactorOfThePathMeasure) {
    const ImportanceMap map = uniform_map(400, 0, nullptr);
    const Vec3 to_light = Vec3(0.6f, 0, 0.8f), tilted = Vec3(0.28f, 0, 0.96f);
    const SurfacePoint flat = point_at(Vec3(0.5f, 0.5f, 0)), shaded = point_at(Vec3(0.5f, 0.5f, 0), tilted);
    const Rgb e_flat = map.importance(flat, diffuse_at(flat), to_light).value;
    const Rgb e_shaded = map.importance(shaded, diffuse_at(shaded), to_light).value;
    EXPECT_NEAR(e_shaded.y / e_flat.y, tilted.dot(to_light) / 0.8, 1e-6);
}

TEST(ImportanceMap, FindsNothingOutsideItsRadius) {
    const ImportanceMap map = uniform_map(400, 0, nullptr);
    const SurfacePoint far = point_at(Vec3(3, 0, 0));
    EXPECT_EQ(map.importance(far, diffuse_at(far), kUp).importons, 0);
}

/// d1 under a uniform point of the window.
std::optional<Vertex> first_vertex(const Scene& scene, const Vertex& eye, Rng& rng) {
    const Vec2 image(static_cast<float>(rng.next()), static_cast<float>(rng.next()));
    return next_vertex(scene, eye, scene.camera().ray_direction(eye.point, image));
}

std::vector<Photon> importons_of_walks(const Scene& scene, int walks, Rng& rng) {
    std::vector<Photon> importons;
    for (int i = 0; i < walks; ++i) {
        const Vertex eye = sample_eye(scene, rng);
        const auto d1 = first_vertex(scene, eye, rng);
        if (!d1) continue;
        const auto on = continue_walk(*d1, direction(d1->point, eye.point), From::eye, rng);
        if (!on) continue;
        const auto d2 = next_vertex(scene, *d1, on->w);
        if (d2) importons.emplace_back(d2->point.p, d2->point.ng, -on->w, on->weight / walks);
    }
    return importons;
}

/// E from walks that start at d2 and are connected to the eye: no importons, no densities.
RunningStats importance_by_walks(const Scene& scene, const Vertex& d2, const Vec3& to_light, Rng& rng) {
    RunningStats stats;
    for (int i = 0; i < 50'000; ++i) {
        const Vertex eye = sample_eye(scene, rng);
        Rgb e(0.0);
        const auto on = continue_walk(d2, to_light, From::light, rng);
        const auto d1 = on ? next_vertex(scene, d2, on->w) : std::nullopt;
        const Vec3 to_eye = d1 ? direction(d1->point, eye.point) : Vec3(0);
        if (d1 && scene.camera().image_point(eye.point, -to_eye) && scene.visible(d1->point, eye.point)) {
            e = on->weight * scatter(d1->point, d1->bsdf, Event::finite, -on->w, to_eye).value *
                solid_angle_to_area(scene.camera().direction_pdf(-to_eye), eye.point, d1->point);
        }
        stats.add(e.y);
    }
    return stats;
}

TEST(ImportanceMap, AgreesWithTheIntegralOverCameraSubPaths) {
    const auto scene = test::diffuse_box();
    const SurfacePatches patches(*scene);
    Rng rng = make_rng(0);
    const ImportanceMap map(importons_of_walks(*scene, 800'000, rng),
                            {.k = 600, .max_radius = 0.4f, .patches = &patches});
    Vertex inside;
    inside.point.site = Site::point;
    inside.point.p = Vec3(0, 1, 1.2f);
    // The middle of walls, places beside an edge, one in a corner, and the front of the ball. By the area of the disc,
    // all but the first two would come out at 0.37 to 0.57 of the truth.
    for (const Vec3& target : {Vec3(0, 0, -0.5f), Vec3(1, 1.2f, -0.3f), Vec3(0.99f, 0, -0.5f), Vec3(-0.99f, 2, -0.5f),
                               Vec3(0.98f, 1.97f, -1), Vec3(-0.3f, 0.45f, -0.05f)}) {
        const auto d2 = next_vertex(*scene, inside, (target - inside.point.p).normalized());
        ASSERT_TRUE(d2);
        const Vec3 to_light = direction(d2->point, inside.point);
        const RunningStats truth = importance_by_walks(*scene, *d2, to_light, rng);
        const auto e = map.importance(d2->point, d2->bsdf, to_light);
        EXPECT_GT(e.importons, 100);
        // 1 / sqrt(600) of noise three times over, and what the finite radius blurs.
        EXPECT_NEAR(e.value.y / truth.mean(), 1, 0.13 + test::most_errors(6) * truth.standard_error() / truth.mean())
            << target << ", known to " << truth.standard_error() / truth.mean();
    }
}

} // namespace
} // namespace keyhole
