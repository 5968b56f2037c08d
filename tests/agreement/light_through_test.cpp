// Lampshades and ground glass: light that surfaces scatter on to their other side is found by methods with photon maps.
#include "methods/method.h"
#include "scene/emitters/emitters.h"
#include "support/same_light.h"
#include "support/settings_from.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

ColorTexture color(double value) { return constant_texture(Rgb(value)); }
FloatTexture value(double x) { return constant_texture(x); }

/// A lamp in a globe, which scatters light on both sides.
std::unique_ptr<Scene> room_with_a_globe() {
    test::SceneMaker m = test::room_with_a_window();
    const Vec3 lamp(1.5f, 1.9f, 1.2f);
    m.rectangle({1, 1, 0}, {0, 0.8f, 0}, {0.8f, 0, 0}, make_diffuse(Rgb(0.6)));
    m.rectangle(lamp - Vec3(0.03f, 0, 0.03f), {0, 0, 0.06f}, {0.06f, 0, 0}, make_diffuse(Rgb(0.2)), Rgb(300.0), true);
    m.sphere(lamp, 0.15f, make_diffuse_transmission(color(0.4), color(0.5)));
    m.rectangle({0, 0.01f, 0}, {0, 0, 3}, {3, 0, 0},
                make_coated_diffuse(color(0.4), value(0.2), value(0.2), 1.5, value(0)));
    m.camera({2.7f, 1.5f, 2.8f}, {0.8f, 0.7f, 0.4f}, 60).window(48, 32);
    return m.build();
}

/// A pane of ground glass in the window, and a lamp in the room.
std::unique_ptr<Scene> room_with_ground_glass() {
    test::SceneMaker m = test::room_with_a_window();
    test::add_pane(m, test::ground_glass());
    m.emitter(make_constant_environment(Rgb(3.0, 4.0, 5.0)));
    m.rectangle({2.2f, 2.3f, 2}, {0.2f, 0, 0}, {0, 0, 0.2f}, make_diffuse(Rgb(0.0)), Rgb(8.0));
    m.camera({2.7f, 1.5f, 2.8f}, {0.8f, 1.0f, 0.2f}, 60).window(48, 32);
    return m.build();
}

/// A room divided by two sheets of cloth, 3 mm apart, a lamp behind them. What arrives at the one from the lamp's side
/// and at the other from between them lies side by side on surfaces that look the same way, and is several times as
/// bright on the one as on the other.
std::unique_ptr<Scene> room_divided_by_double_cloth() {
    test::SceneMaker m;
    const auto cloth = make_diffuse_transmission(color(0.3), color(0.3));
    m.room({0, 0, 0}, {3, 2.5f, 3}, make_diffuse(Rgb(0.6)));
    m.rectangle({0, 0, 1}, {0, 2.5f, 0}, {3, 0, 0}, cloth);
    m.rectangle({0, 0, 1.003f}, {3, 0, 0}, {0, 2.5f, 0}, cloth);
    m.rectangle({1, 1, 0.4f}, {0, 0.5f, 0}, {0.5f, 0, 0}, make_diffuse(Rgb(0.0)), Rgb(100.0)); // faces the far wall
    m.camera({2.7f, 1.5f, 2.8f}, {1.3f, 1.2f, 1}, 60).window(48, 32);
    return m.build();
}

void expect_the_same_by_all(Scene& scene) {
    Settings base = test::settings_from("max_depth=10 spp=8 brightness_samples=20k importons=15k mutations=300k "
                                        "light_paths=80k photons=40k chains=200 cache_rays=150");
    Settings paths = base;
    paths.method = &methods::bdpt;
    paths.spp = 128;
    std::vector<Settings> photons = test::by_methods(base, {"pm", "ipm", "mps", "ipm"});
    photons.back().gather_coverage = false;
    test::expect_same_light(scene, paths, photons, 4);
}

TEST(LightThrough_AGlobe, IsTheSameByAllMethods) { expect_the_same_by_all(*room_with_a_globe()); }
TEST(LightThrough_GroundGlass, IsTheSameByAllMethods) { expect_the_same_by_all(*room_with_ground_glass()); }
TEST(LightThrough_DoubleCloth, IsToldApartByFaces) { expect_the_same_by_all(*room_divided_by_double_cloth()); }

} // namespace
} // namespace keyhole
