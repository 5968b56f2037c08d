// Shading normals far from the surface's own: no light goes through closed walls, and methods agree on bumped surfaces.
#include "methods/method.h"
#include "methods/render.h"
#include "scene/emitters/emitters.h"
#include "support/agreement.h"
#include "support/same_light.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

/// Waves of `height` metres, so many over a rectangle each way.
class Waves final : public Texture<double> {
  public:
    Waves(double height, double number) : height_(height), number_(number) {}
    double value(const SurfacePoint& p) const override {
        return height_ * std::sin(2 * kPi * number_ * p.uv.x) * std::sin(2 * kPi * number_ * p.uv.y);
    }

  private:
    double height_, number_;
};

/// White paint whose normals are up to 45 degrees off on a wall of 4 m.
test::MaterialPtr waves() { return with_bump(make_diffuse(Rgb(0.6)), std::make_shared<Waves>(0.016, 40)); }

class ShadingNormals_ClosedRoom : public testing::TestWithParam<const char*> {};

TEST_P(ShadingNormals_ClosedRoom, IsBlackUnderASun) {
    test::SceneMaker m;
    m.room({0, 0, 0}, {4, 4, 4}, waves());
    m.emitter(make_distant_emitter(Vec3(-0.9f, -0.35f, -0.25f).normalized(), Rgb(100.0)));
    m.camera({3.5f, 2, 3.5f}, {0, 1.5f, 0}, 70).window(24, 16);
    const auto scene = m.build();
    Settings s = test::settings_from("max_depth=4 spp=4 brightness_samples=5k importons=5k mutations=10k "
                                     "light_paths=20k photons=10k chains=50");
    s.method = &method_named(GetParam());
    const RenderResult result = render(*scene, s, {});
    for (const float v : result.picture.layers.at("beauty").data) ASSERT_EQ(v, 0);
}

INSTANTIATE_TEST_SUITE_P(Methods, ShadingNormals_ClosedRoom,
                         testing::Values("path", "bdpt", "mlt", "mmlt", "ipm", "pm"),
                         [](const auto& method) { return std::string(method.param); });

TEST(ShadingNormals_BumpedFloor, LightsARoomTheSameByAllMethods) {
    const auto scene = [] {
        test::SceneMaker m;
        const auto plain = make_diffuse(Rgb(0.6));
        m.rectangle({0, 0, 0}, {0, 0, 4}, {4, 0, 0}, waves()); // lit by the sun, and seen by nobody
        m.rectangle({0, 3, 0}, {4, 0, 0}, {0, 0, 4}, plain);
        m.rectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, plain);
        m.emitter(make_distant_emitter(Vec3(-0.6f, -0.35f, -0.4f).normalized(), Rgb(20.0)));
        m.camera({2, 1.2f, 3.9f}, {2, 2.4f, 0}, 60).window(48, 32);
        return m.build();
    }();
    const Settings base = test::settings_from("max_depth=6 spp=8 brightness_samples=20k importons=15k mutations=300k "
                                              "light_paths=80k photons=40k chains=200 cache_rays=150");
    Settings paths = base;
    paths.method = &methods::bdpt;
    paths.spp = 128;
    test::expect_same_light(*scene, paths, test::by_methods(base, {"path", "pm", "ipm", "mps"}), 4);
}

} // namespace
} // namespace keyhole
