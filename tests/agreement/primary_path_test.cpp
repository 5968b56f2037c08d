// Bidirectional path tracing and the chains in primary sample space make the picture that path tracing makes.
#include "support/agreement.h"
#include "support/test_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

namespace keyhole {
namespace {

struct Case {
    const char* name;
    std::function<std::unique_ptr<Scene>()> make;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

/// A method with the setting that this scene tries with it. Every value of each meets some scene.
struct Variant {
    const char *method, *builder, *failures, *mis;
};

constexpr int kRuns = 4;

Settings base() {
    Settings s;
    s.max_depth = 8;
    s.brightness_samples = 30'000;
    s.chains = 200;
    return s;
}

class PrimarySampleSpace_AgreesWithPathTracing : public testing::TestWithParam<std::tuple<Case, int>> {};

TEST_P(PrimarySampleSpace_AgreesWithPathTracing, BlockByBlock) {
    const auto& [scene_case, shift] = GetParam();
    const auto scene = scene_case.make();
    Settings path = base();
    path.method = "path";
    path.spp = 32;
    path.seed = 1000;
    const test::Blocks reference = test::render_blocks(*scene, path, kRuns);

    constexpr std::array failures{"reject", "exclude_large", "delay"};
    constexpr std::array heuristics{"balance", "power", "maximum"};
    const auto pick = [&](const auto& words, int i) {
        return words[static_cast<std::size_t>(shift + i) % words.size()];
    };
    for (const Variant& v :
         {Variant{"bdpt", "path", "reject", pick(heuristics, 0)}, Variant{"pssmlt", "path", pick(failures, 0), "power"},
          Variant{"pssmlt", "endpoints", pick(failures, 1), pick(heuristics, 1)},
          Variant{"pssmlt", "bidirectional", pick(failures, 2), pick(heuristics, 2)},
          Variant{"mmlt", "path", pick(failures, 0), pick(heuristics, 0)},
          Variant{"rjmlt", "path", pick(failures, 1), shift == 1 ? "balance" : "power"}}) {
        Settings s = base();
        s.method = v.method;
        s.builder = v.builder;
        s.failures = v.failures;
        s.mis = v.mis;
        s.spp = 6;
        s.mutations = 60'000;
        const test::Disagreement d = test::compare(test::render_blocks(*scene, s, kRuns), reference, 0.03);
        EXPECT_EQ(d.rejected, 0) << fmt::format("{} {} {} {}\n{}mean brightness ratio {}", v.method, v.builder,
                                                v.failures, v.mis, d.report, d.ratio);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, PrimarySampleSpace_AgreesWithPathTracing,
    testing::Values(std::tuple(Case{"diffuse", test::diffuse_box}, 0),
                    std::tuple(Case{"mirrors_and_lens", [] { return test::mirror_glass_box(0.05f); }}, 1),
                    std::tuple(Case{"haze", test::hazy_box}, 2), std::tuple(Case{"sky", test::sky_box}, 0),
                    std::tuple(Case{"two_rooms", [] { return test::two_rooms(0.8f); }}, 1)),
    [](const auto& info) { return std::string(std::get<0>(info.param).name); });

} // namespace
} // namespace keyhole
