// Every kind of proposal alone, on scenes that differ in what paths they have.
#include "scene/load/load.h"
#include "support/invariance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// What a scene has for proposals of some kinds to do.
enum class Specular {
    none,
    seldom_met,
    mirrors_and_glass,
    flat_mirrors,
    small_lamp_in_mirrors, ///< whose caustics, seen in a flat mirror, one independent path in 100,000 finds
};

struct SceneCase {
    const char* name;
    std::unique_ptr<Scene> (*make)();
    Specular specular;
    std::int64_t samples = 120'000;
};

const SceneCase kScenes[] = {
    {"DiffuseBox", test::diffuse_box, Specular::none},
    {"MirrorGlassBox", [] { return test::mirror_glass_box(); }, Specular::small_lamp_in_mirrors},
    {"ThinLens", [] { return test::mirror_glass_box(0.1f); }, Specular::small_lamp_in_mirrors},
    {"PointLight", test::point_light_box, Specular::mirrors_and_glass},
    {"TwoRooms", [] { return test::two_rooms(0.5f); }, Specular::none},
    {"RoomsLow",
     [] {
         return std::make_unique<Scene>(load_scene(KEYHOLE_SOURCE_DIR "/tests/data/rooms_low/rooms.yaml").description);
     },
     Specular::seldom_met},
    {"MirrorCorner", [] { return test::mirror_corner_box(); }, Specular::flat_mirrors},
    {"MirrorCornerThinLens", [] { return test::mirror_corner_box(0.1f); }, Specular::flat_mirrors},
    {"Furnace", [] { return test::furnace(0.6); }, Specular::none},
    {"Haze", test::hazy_box, Specular::flat_mirrors},
    {"Coat", test::coated_box, Specular::flat_mirrors},           // smooth, and rough below
    {"Sky", test::sky_box, Specular::mirrors_and_glass, 200'000}, // few light paths come in
    {"DistantLight", test::distant_light_scene, Specular::mirrors_and_glass},
    {"Spot", test::spot_scene, Specular::mirrors_and_glass},
};

/// Kinds that need no user paths; user_paths_test.cpp has the others.
const std::size_t kKindsAlone = static_cast<std::size_t>(
    std::ranges::count_if(proposal_kinds(), [](const ProposalKind* k) { return !k->needs_user_paths; }));
const ProposalKind& kind_that_stands_alone(std::size_t index) {
    for (const ProposalKind* kind : proposal_kinds())
        if (!kind->needs_user_paths && index-- == 0) return *kind;
    throw std::out_of_range("no such kind");
}

class Proposal_LeavesTheTargetAlone : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {};

TEST_P(Proposal_LeavesTheTargetAlone, Alone) {
    const auto [kind_index, scene_index] = GetParam();
    const ProposalKind& kind = kind_that_stands_alone(kind_index);
    const SceneCase& scene_case = kScenes[scene_index];
    const auto scene = scene_case.make();
    const ProposalContext context{scene.get(), PathSet::stored, 8};
    Mixture<Path> mixture;
    if (kind.make(context).empty()) {
        EXPECT_EQ(&kind, &proposals::mirrored_light_tracing);
        EXPECT_LT(scene_case.specular, Specular::flat_mirrors);
        return;
    }
    if (&kind == &proposals::mirrored_light_tracing && scene_case.specular == Specular::small_lamp_in_mirrors)
        GTEST_SKIP() << "too few of the draws have what this kind makes; MirrorCorner has many";
    for (auto& [proposal, share] : kind.make(context)) mixture.add(std::move(proposal), share);
    // Caustics of lights that no ray from the eye can hit are missing from the target's draws by path tracing.
    const bool from_light = &kind == &proposals::light_tracing || &kind == &proposals::mirrored_light_tracing;
    const test::Invariance result =
        test::measure_invariance(*scene, mixture, PathSet::stored, scene_case.samples, 11, 8,
                                 from_light ? Technique::bidirectional : Technique::path);
    const LedgerEntry& counts = result.ledger.at(0);
    if (kind.needs_specular && scene_case.specular == Specular::none) {
        EXPECT_EQ(counts.proposed, 0u) << "needs_specular leaves the kind out of mixtures for scenes like this one";
        return;
    }
    if (kind.needs_specular && scene_case.specular == Specular::seldom_met) {
        EXPECT_GT(counts.proposed, 0u);
        GTEST_SKIP() << "a mirror and a vase that few paths meet: too few proposals to judge";
    }
    EXPECT_GT(counts.proposed, 100u);
    EXPECT_GT(counts.accepted, 50u);
    // Rounding of positions may put a step outside its support: seldom.
    EXPECT_LE(counts.nan * 10'000, counts.proposed);
    EXPECT_LE(result.worst(), test::Invariance::bound()) << result.report();
}

INSTANTIATE_TEST_SUITE_P(Kinds, Proposal_LeavesTheTargetAlone,
                         testing::Combine(testing::Range<std::size_t>(0, kKindsAlone),
                                          testing::Range<std::size_t>(0, std::size(kScenes))),
                         [](const auto& info) {
                             const std::string key = kind_that_stands_alone(std::get<0>(info.param)).weight.key;
                             return key.substr(0, key.find('.')) + "_" + kScenes[std::get<1>(info.param)].name;
                         });

} // namespace
} // namespace keyhole
