// Paths of few scatterings: those that mirrors and glass on the eye's side take are missing from the light that comes
// that way, by every method; of so many that it doesn't matter, none are.
#include "methods/method.h"
#include "support/agreement.h"
#include "support/same_light.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <iostream>

namespace keyhole {
namespace {

/// A white room, most of it seen through a ball of glass and in a mirror that leans against its wall.
std::unique_ptr<Scene> room_behind_glass() {
    test::SceneMaker m;
    m.room({0, 0, 0}, {3, 3, 3}, make_diffuse(Rgb(0.7)));
    m.rectangle({1, 2.9f, 1}, {1, 0, 0}, {0, 0, 1}, make_diffuse(Rgb(0.0)), Rgb(10.0)); // faces down
    m.sphere({1.2f, 1.1f, 1.5f}, 0.7f, make_glass(1.5));
    m.rectangle({2.2f, 0.3f, 0.2f}, {0.7f, 0, 0.4f}, {0, 2, -0.1f}, make_mirror(Rgb(0.9)));
    m.camera({1.5f, 1.5f, 2.95f}, {1.5f, 1.3f, 0}, 60).window(48, 32);
    return m.build();
}

Settings few_scatterings(std::int64_t depth) {
    Settings s = test::settings_from(
        "spp=16 brightness_samples=50k brightness_error=0 importons=20k mutations=200k light_paths=50k "
        "photons=30k chains=200 cache_rays=200");
    s.max_depth = depth;
    return s;
}

class ShortPaths : public testing::TestWithParam<std::int64_t> {};

/// Light of a layer by methods that keep photons is that of path tracing.
void expect_same_light(Scene& scene, const Settings& base, const std::string& layer) {
    Settings paths = base;
    paths.method = &methods::path;
    paths.spp = 48;
    paths.seed = 1000;
    const test::Blocks expected = test::render_blocks(scene, paths, 8, layer);
    std::vector<Settings> photons = test::by_methods(base, {"pm", "ipm", "mps", "ipm"});
    photons.back().irradiance_cache = false; // gather rays of each sample know how long their way is
    for (const Settings& s : photons) {
        const test::Disagreement d = test::compare(test::render_blocks(scene, s, 3, layer), expected, 0.03);
        std::cout << name_of(*s.method) << ": ratio " << d.ratio << " +- " << d.ratio_error << ", worst " << d.worst
                  << ", errors up to " << d.largest_error << "\n";
        EXPECT_EQ(d.rejected, 0) << name_of(*s.method) << "\n" << d.report;
        EXPECT_LT(d.worst, 0.07) << name_of(*s.method);
        EXPECT_LT(d.largest_error, 0.03) << "too noisy to say";
    }
}

TEST_P(ShortPaths, LeaveOutTheSameIndirectLightByEveryMethod) {
    const auto scene = room_behind_glass();
    expect_same_light(*scene, few_scatterings(GetParam()), "indirect");
}

/// A lamp, and one that shines through two panes: of its light, what is too long with them is missing, too.
TEST_P(ShortPaths, LookThroughAsManyPanesAsTheyMay) {
    test::SceneMaker m;
    m.room({0, 0, 0}, {3, 3, 3}, make_diffuse(Rgb(0.7)));
    m.rectangle({0.5f, 2.9f, 1}, {0.7f, 0, 0}, {0, 0, 0.7f}, make_diffuse(Rgb(0.0)), Rgb(10.0)); // face down
    m.rectangle({1.8f, 2.9f, 1}, {0.7f, 0, 0}, {0, 0, 0.7f}, make_diffuse(Rgb(0.0)), Rgb(10.0));
    for (const float height : {2.6f, 2.7f})
        m.rectangle({1.5f, height, 0}, {1.5f, 0, 0}, {0, 0, 3}, make_thin_dielectric(1.5));
    m.camera({1.5f, 1.5f, 2.95f}, {1.5f, 1.2f, 0}, 60).window(48, 32);
    const auto scene = m.build();
    const std::int64_t depth = GetParam() - 1; // both lamps, one in the first bounce alone, or everywhere
    expect_same_light(*scene, few_scatterings(depth), "beauty");
}

/// There no photon may be stored, and what gather rays meet is lit directly.
TEST(ShortPaths_OfTwoScatterings, LeaveOutWhatAMirrorMakesTooLong) {
    const auto scene = room_behind_glass();
    Settings settings = few_scatterings(2);
    settings.spp = 64;
    expect_same_light(*scene, settings, "indirect");
}

INSTANTIATE_TEST_SUITE_P(Scatterings, ShortPaths, testing::Values(3, 5, 40),
                         [](const auto& info) { return std::to_string(info.param); });

} // namespace
} // namespace keyhole
