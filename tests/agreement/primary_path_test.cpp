// Bidirectional path tracing and the chains in primary sample space make the picture that path tracing makes.
#include "methods/method.h"
#include "support/agreement.h"
#include "support/settings_from.h"
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
    const Method* method;
    PathBuilderKind builder;
    Failures failures;
    MisHeuristic mis;
};

constexpr int kRuns = 8;

Settings base() { return test::settings_from("max_depth=8 brightness_samples=8k chains=50"); }

class PrimarySampleSpace_AgreesWithPathTracing : public testing::TestWithParam<std::tuple<Case, int>> {};

TEST_P(PrimarySampleSpace_AgreesWithPathTracing, BlockByBlock) {
    const auto& [scene_case, shift] = GetParam();
    const auto scene = scene_case.make();
    Settings independent = base();
    independent.method = &methods::path;
    independent.spp = 8;
    independent.seed = 1000;
    const test::Blocks reference = test::render_blocks(*scene, independent, kRuns);

    using enum PathBuilderKind;
    constexpr std::array failures{Failures::reject, Failures::exclude_large, Failures::delay};
    constexpr std::array heuristics{MisHeuristic::balance, MisHeuristic::power, MisHeuristic::maximum};
    const auto pick = [&](const auto& choices, int i) {
        return choices[static_cast<std::size_t>(shift + i) % choices.size()];
    };
    for (const Variant& v : {Variant{&methods::bdpt, path, Failures::reject, pick(heuristics, 0)},
                             Variant{&methods::pssmlt, path, pick(failures, 0), MisHeuristic::power},
                             Variant{&methods::pssmlt, endpoints, pick(failures, 1), pick(heuristics, 1)},
                             Variant{&methods::pssmlt, bidirectional, pick(failures, 2), pick(heuristics, 2)},
                             Variant{&methods::mmlt, path, pick(failures, 0), pick(heuristics, 0)},
                             Variant{&methods::rjmlt, path, pick(failures, 1),
                                     shift == 1 ? MisHeuristic::balance : MisHeuristic::power}}) {
        Settings s = base();
        s.method = v.method;
        s.builder = v.builder;
        s.failures = v.failures;
        s.mis = v.mis;
        s.spp = 2;
        s.mutations = 15'000;
        const test::Disagreement d = test::compare(test::render_blocks(*scene, s, kRuns), reference, 0.03);
        EXPECT_EQ(d.rejected, 0) << fmt::format("{} {} {} {}\n{}mean brightness ratio {}", name_of(*v.method),
                                                word_of(v.builder), word_of(v.failures), word_of(v.mis), d.report,
                                                d.ratio);
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
