#include "photonmap/importance_map.h"

#include "core/statistics.h"
#include "photon_support.h"

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
        EXPECT_LT(std::abs(reciprocal.mean() - expected), 4 * reciprocal.standard_error());
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

} // namespace
} // namespace keyhole
