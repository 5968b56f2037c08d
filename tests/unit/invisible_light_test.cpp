// Area lights of opacity 0: no ray meets them, and light sampling finds what they would send if they were seen.
#include "core/statistics.h"
#include "photonmap/surface/surface_patches.h"
#include "sampling/paths/direct_light.h"
#include "sampling/paths/measure.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using test::SceneMaker;

/// A lamp of 1 x 1 m, a metre above a white floor.
std::unique_ptr<Scene> lamp_over_floor(double alpha) {
    SceneMaker m;
    m.rectangle({-9, 0, -9}, {0, 0, 18}, {18, 0, 0}, make_diffuse(Rgb(1.0)));
    m.rectangle({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, make_diffuse(Rgb(0.5)), Rgb(3.0)).alpha(alpha);
    return m.build();
}

SurfacePoint place(const Vec3& p) {
    SurfacePoint s;
    s.p = p;
    s.site = Site::point;
    return s;
}

/// Light of all lamps that the floor below the lamp's middle reflects straight up, found as a path tracer does.
double reflected(const Scene& scene) {
    const Vec3 up(0, 1, 0);
    const Vertex v = next_vertex(scene, place({0, 0.5f, 0}), -up).value();
    Rng rng(4, StreamPurpose::test, 0);
    RunningStats mean;
    for (int i = 0; i < 200'000; ++i) {
        const auto light = sample_direct_light(scene, v, up, rng);
        mean.add(light && scene.visible(v.point, light->x0.point) ? light->value.y : 0.0);
    }
    EXPECT_LT(mean.standard_error(), 0.01 * mean.mean());
    return mean.mean();
}

TEST(InvisibleLight_Rays, PassThroughIt) {
    const auto scene = lamp_over_floor(0);
    const SurfacePoint above = place({0.1f, 2, 0.1f}), below = place({0.1f, 0.5f, 0.1f});
    EXPECT_NEAR(scene->trace(above, {0, -1, 0}).value().p.y, 0, 1e-6);
    EXPECT_TRUE(scene->visible(above, below));
    EXPECT_FALSE(scene->trace(below, {0, 1, 0}).has_value());
}

TEST(InvisibleLight_Surface, HoldsNoPhotons) {
    const auto scene = lamp_over_floor(0);
    const SurfacePatches patches(scene->shapes());
    EXPECT_EQ(patches.area({{0, 1, 0}, {0, -1, 0}}, 0.1), 0);
}

TEST(InvisibleLight_Light, IsFoundBySamplingItAlone) {
    const auto scene = lamp_over_floor(0);
    // A square of side 1 a metre away, seen from below its middle: configuration factor of four quarters
    // (Howell, C-17), 4/(2 pi) * 2 a/sqrt(1+a^2) atan(a/sqrt(1+a^2)) with a = 1/2.
    const double a = 0.5, s = std::sqrt(1 + a * a), factor = 4 / kPi * a / s * std::atan(a / s);
    EXPECT_NEAR(reflected(*scene), 3 * factor, 0.01 * 3 * factor);
}

// No weight is left to rays that would hit it, for none do.
TEST(InvisibleLight_Density, OfBeingHitIsZero) {
    const auto scene = lamp_over_floor(0);
    ASSERT_EQ(scene->emitters().size(), 1u);
    EXPECT_TRUE(scene->emitter(0).is_delta());
    EXPECT_EQ(scene->emitter(0).site(), Site::surface);
    EXPECT_FALSE(lamp_over_floor(1)->emitter(0).is_delta());
    EXPECT_FALSE(lamp_over_floor(0.5)->emitter(0).is_delta());
    Path path;
    Rng rng(5, StreamPurpose::test, 0);
    SurfacePoint x0 = scene->emitter(0).sample_point(rng).point;
    x0.emitter = 0;
    const Vertex floor = next_vertex(*scene, place({0, 0.5f, 0}), {0, -1, 0}).value();
    path.x.push_back(make_vertex(x0));
    path.x.push_back(floor);
    path.x.push_back(make_vertex(place({0, 0.5f, 0})));
    for (Vertex& v : path.x) v.event = Event::finite;
    measure(*scene, path);
    EXPECT_EQ(path.x[0].pdf_from_eye, 0);
    EXPECT_GT(path.x[0].pdf_from_light, 0);
}

} // namespace
} // namespace keyhole
