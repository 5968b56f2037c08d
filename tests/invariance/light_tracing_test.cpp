// A constant factor of a density cancels where a kind is alone, and next to where it stands beside kinds that seldom
// make the same paths. So the density of whole new paths is held against how many are made.
#include "core/statistics.h"
#include "sampling/paths/independent_paths.h"
#include "sampling/proposals/registry.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr int kMostScatterings = 8;
constexpr std::int64_t kSamples = 60'000;

Rng stream(std::uint64_t seed, std::int64_t i) { return {seed, StreamPurpose::test, static_cast<std::uint64_t>(i)}; }

/// The integral over all paths that carry light of the density with which a kind makes them: independent paths y, each
/// of which stands for contribution over f(y) of a uniform one.
struct DensityIntegral {
    const Proposal<Path>& kind;
    std::optional<Path> from{}; ///< where the move begins: a path that has nothing in common with those to come
    double sum = 0;
    std::optional<Path> last{};

    void contribution(const Rgb& value, PhotonKind, auto&& make_path) {
        Path y = make_path();
        const double target = luminance(y.contribution);
        if (from && target > 0) sum += luminance(value) / target * kind.transition_density(*from, y);
        last = std::move(y);
    }
};

struct SceneOfDensity {
    const char* name;
    std::unique_ptr<Scene> (*make)();
};

class LightTracing_Density : public testing::TestWithParam<SceneOfDensity> {};

TEST_P(LightTracing_Density, AddsUpToTheShareOfProposalsThatCarryLight) {
    const auto scene = GetParam().make();
    const auto list = proposals::light_tracing.make({scene.get(), PathSet::stored, kMostScatterings});
    const Proposal<Path>& kind = *list.at(0).proposal;

    RunningStats integral, made;
    DensityIntegral sink{kind};
    for (std::int64_t i = 0; i < kSamples; ++i) {
        Rng rng = stream(31, i);
        const Vec2 image(static_cast<float>(rng.next()), static_cast<float>(rng.next()));
        sink.sum = 0;
        sink.from = sink.last;
        trace_independent(Technique::bidirectional, *scene, image, {kMostScatterings, PathSet::stored}, rng, sink);
        if (!sink.from) continue;
        integral.add(sink.sum);
        Rng own = stream(32, i);
        Failure why{};
        const auto y = kind.propose(*sink.from, own, why);
        made.add(y && y->target > 0 ? 1 : 0);
    }
    EXPECT_LT(std::hypot(integral.standard_error(), made.standard_error()), 0.03 * made.mean());
    EXPECT_NEAR(integral.mean(), made.mean(), 4 * std::hypot(integral.standard_error(), made.standard_error()));
}

INSTANTIATE_TEST_SUITE_P(Scenes, LightTracing_Density,
                         testing::Values(SceneOfDensity{"DiffuseBox", test::diffuse_box},
                                         SceneOfDensity{"ThinLens", [] { return test::mirror_glass_box(0.1f); }},
                                         SceneOfDensity{"PointLight", test::point_light_box},
                                         SceneOfDensity{"Haze", test::hazy_box}),
                         [](const auto& info) { return info.param.name; });

} // namespace
} // namespace keyhole
