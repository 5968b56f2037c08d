// A constant factor of a density cancels where a kind is alone, and next to where it stands beside kinds that seldom
// make the same paths. So the density of whole new paths is held against how many are made, joined to the lens straight
// and by way of mirrors.
#include "core/statistics.h"
#include "sampling/paths/independent_paths.h"
#include "sampling/proposals/registry.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr int kMostScatterings = 8;

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
    const ProposalKind* kind;
    std::unique_ptr<Scene> (*make)();
    std::int64_t samples = 60'000;
};

class LightTracing_Density : public testing::TestWithParam<SceneOfDensity> {};

TEST_P(LightTracing_Density, AddsUpToTheShareOfProposalsThatCarryLight) {
    const auto scene = GetParam().make();
    const auto list = GetParam().kind->make({scene.get(), PathSet::stored, kMostScatterings});
    const Proposal<Path>& kind = *list.at(0).proposal;

    RunningStats integral, made;
    DensityIntegral sink{kind};
    for (std::int64_t i = 0; i < GetParam().samples; ++i) {
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

const ProposalKind* const kStraight = &proposals::light_tracing;
const ProposalKind* const kMirrored = &proposals::mirrored_light_tracing;
std::unique_ptr<Scene> lens() { return test::mirror_glass_box(0.1f); }

INSTANTIATE_TEST_SUITE_P(Scenes, LightTracing_Density,
                         testing::Values(SceneOfDensity{"DiffuseBox", kStraight, test::diffuse_box},
                                         SceneOfDensity{"ThinLens", kStraight, lens},
                                         SceneOfDensity{"PointLight", kStraight, test::point_light_box},
                                         SceneOfDensity{"Haze", kStraight, test::hazy_box},
                                         SceneOfDensity{"MirrorCorner", kMirrored,
                                                        [] { return test::mirror_corner_box(); }, 120'000},
                                         SceneOfDensity{"MirrorCornerThinLens", kMirrored,
                                                        [] { return test::mirror_corner_box(0.1f); }, 120'000},
                                         SceneOfDensity{"MirrorCoat", kMirrored, test::coated_box, 300'000}),
                         [](const auto& info) { return info.param.name; });

} // namespace
} // namespace keyhole
