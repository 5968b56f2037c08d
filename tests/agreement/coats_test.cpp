// Rooms in which nearly everything has a coat: what photons and cached irradiance make of diffuse and glossy parts is
// what paths make of the whole.
#include "methods/method.h"
#include "scene/emitters/emitters.h"
#include "scene/load/load.h"
#include "support/agreement.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"
#include "support/window_room.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

using test::MaterialPtr;

MaterialPtr varnished(const Rgb& base, double alpha) {
    return make_coated_diffuse(constant_texture(base), constant_texture(alpha), constant_texture(alpha), 1.5,
                               constant_texture(0.0));
}

MaterialPtr principled(const Rgb& base, double alpha, double metallic, double clearcoat, double coat_alpha = 0.02) {
    const auto value = [](double x) { return constant_texture(x); };
    return make_principled({constant_texture(base), value(metallic), value(alpha), value(alpha), value(0.04), value(0),
                            value(0), value(clearcoat), value(coat_alpha), value(0), value(0)});
}

/// Plastic walls, a lacquered floor, and a ball of lacquered metal; the lamp shines at the ceiling.
std::unique_ptr<Scene> plastic_box() {
    const auto white = principled(Rgb(0.75), 0.25, 0, 0), red = principled(Rgb(0.7, 0.25, 0.2), 0.1, 0, 0);
    test::SceneMaker m;
    m.room({-1, 0, -1}, {1, 2, 3}, white)
        .rectangle({-1, 0.01f, -1}, {0, 0, 4}, {2, 0, 0}, principled(Rgb(0.5, 0.35, 0.2), 0.3, 0, 4))
        .rectangle({-0.99f, 0, -1}, {0, 2, 0}, {0, 0, 4}, red)
        .rectangle({-0.3f, 1.4f, -0.3f}, {0, 0, 0.6f}, {0.6f, 0, 0}, make_diffuse(Rgb(0.0)), Rgb(40.0))
        .sphere({-0.4f, 0.45f, -0.4f}, 0.4f, principled(Rgb(0.8, 0.6, 0.3), 0.3, 1, 4))
        .camera({0, 1, 2.9f}, {0, 0.95f, -1}, 42)
        .window(48, 32);
    return m.build();
}

/// A floor and a wall with a rough gloss under a smooth coat, below an even sky that samples of the BSDF find as often
/// as samples of the emitter do.
std::unique_ptr<Scene> lacquered_corner() {
    const auto lacquer = principled(Rgb(0.5), 0.5, 0, 4, 0);
    test::SceneMaker m;
    m.rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, lacquer)
        .rectangle({-2, 0, -2}, {0, 2, 0}, {0, 0, 4}, lacquer)
        .emitter(make_constant_environment(Rgb(1.0)))
        .camera({1.5f, 1.2f, 2.5f}, {-0.8f, 0.4f, -0.6f}, 42)
        .window(48, 32);
    return m.build();
}

/// Varnish in daylight: a sky, and a sun that comes in by the window.
std::unique_ptr<Scene> varnished_daylight() {
    test::SceneMaker m = test::room_with_a_window(varnished(Rgb(0.7), 0.3));
    m.rectangle({0, 0.01f, 0}, {0, 0, 3}, {3, 0, 0}, varnished(Rgb(0.5, 0.35, 0.2), 0.1))
        .sphere({1, 0.4f, 1.4f}, 0.39f, varnished(Rgb(0.2, 0.35, 0.6), 0))
        .emitter(make_constant_environment(Rgb(3.0, 4.0, 5.0)))
        .emitter(make_distant_emitter(Vec3(-0.2f, -0.6f, 0.75f).normalized(), Rgb(20.0), 4))
        .camera({2.7f, 1.5f, 2.8f}, {0.8f, 0.7f, 0.4f}, 55)
        .window(48, 32);
    return m.build();
}

/// The one that is shipped, and the main picture of the README; with a sun large enough for path tracing to find the
/// light that it sends through glass.
std::unique_ptr<Scene> kitchen() {
    SceneDescription description = load_scene(KEYHOLE_SOURCE_DIR "/scenes/kitchen.yaml").description;
    description.emitters.clear();
    description.emitters.push_back(make_constant_environment(Rgb(3.0, 4.0, 5.6)));
    description.emitters.push_back(
        make_distant_emitter(Vec3(-0.30f, -0.46f, 0.72f).normalized(), Rgb(62.0, 55.0, 44.0), 8));
    auto scene = std::make_unique<Scene>(std::move(description));
    scene->set_window({48, 32, 0});
    return scene;
}

template <int kPercent> std::unique_ptr<Scene> varnished_box() {
    auto scene = test::varnished_box(kPercent / 100.0);
    scene->set_window({48, 32, 0});
    return scene;
}

struct CoatCase {
    const char* name;
    std::unique_ptr<Scene> (*make)();
    int spp;       ///< of the paths
    int noisy = 0; ///< blocks of which nothing can be told
};

void PrintTo(const CoatCase& c, std::ostream* out) { *out << c.name; }

constexpr int kRuns = 4;
/// Of paths and chains, which need no maps: Student's distribution makes less of many short ones than of few long ones.
constexpr int kShortRuns = 8;

Settings settings(const char* method, bool cache) {
    Settings s = test::settings_from(
        "spp=4 brightness_samples=10k brightness_error=0 importons=20k mutations=80k light_paths=40k "
        "photons=20k chains=200 cache_rays=200");
    s.method = &method_named(method);
    s.irradiance_cache = cache;
    return s;
}

class Coats_AgreeWithPaths : public testing::TestWithParam<CoatCase> {};

TEST_P(Coats_AgreeWithPaths, BlockByBlock) {
    const CoatCase& c = GetParam();
    const auto scene = c.make();
    Settings paths = settings("bdpt", false);
    paths.spp = c.spp;
    paths.seed = 1000;
    const test::Blocks reference = test::render_blocks(*scene, paths, kShortRuns);
    const auto expect_agreement = [&](const char* method, bool cache) {
        Settings s = settings(method, cache);
        if (s.method == &methods::path) s.spp = c.spp;
        if (s.method == &methods::mlt) {
            s.spp = 6;
            s.mutations = 30'000;
        }
        const int runs = s.method->keeps_photons ? kRuns : kShortRuns;
        const test::Disagreement d = test::compare(test::render_blocks(*scene, s, runs), reference, 0.03);
        fmt::print("{} {}{}: ratio {:.4f}, worst {:.4f}, largest error {:.4f}\n", c.name, method,
                   cache ? ", cached" : "", d.ratio, d.worst, d.largest_error);
        EXPECT_EQ(d.rejected, 0) << method << "\n" << d.report << "mean brightness ratio " << d.ratio;
        EXPECT_NEAR(d.quiet_ratio, 1, c.noisy > 0 ? 0.05 : 0.03) << method;
        EXPECT_TRUE(c.noisy > 0 || d.largest_error < 0.08) << method << ": too noisy to tell, " << d.largest_error;
        EXPECT_LE(d.noisy, c.noisy) << method << ": too noisy to tell, errors up to " << d.largest_error;
    };
    expect_agreement("path", false);
    expect_agreement("mlt", false);
    expect_agreement("ipm", true);
    expect_agreement("ipm", false);
    expect_agreement("mps", true);
}

INSTANTIATE_TEST_SUITE_P(Rooms, Coats_AgreeWithPaths,
                         testing::Values(CoatCase{"smooth", varnished_box<0>, 12},
                                         CoatCase{"rough", varnished_box<20>, 8}, CoatCase{"plastic", plastic_box, 10},
                                         CoatCase{"lacquer", lacquered_corner, 8},
                                         CoatCase{"daylight", varnished_daylight, 40, 1},
                                         CoatCase{"kitchen", kitchen, 40, 1}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace keyhole
