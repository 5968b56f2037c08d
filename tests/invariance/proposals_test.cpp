// Every kind of proposal alone, on scenes that differ in what paths they have.
#include "scene/load/scene_yaml.h"
#include "support/invariance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

struct SceneCase {
    const char* name;
    std::unique_ptr<Scene> (*make)();
};

const SceneCase kScenes[] = {
    {"DiffuseBox", test::diffuse_box},
    {"MirrorGlassBox", [] { return test::mirror_glass_box(); }},
    {"ThinLens", [] { return test::mirror_glass_box(0.1f); }},
    {"PointLight", test::point_light_box},
    {"TwoRooms", [] { return test::two_rooms(0.5f); }},
    {"RoomsLow",
     [] {
         return std::make_unique<Scene>(load_scene(KEYHOLE_SOURCE_DIR "/tests/data/rooms_low/rooms.yaml").description);
     }},
    {"Furnace", [] { return test::furnace(0.6); }},
    {"Haze", test::hazy_box},
    {"Coat", test::coated_box},
    {"Sky", test::sky_box},
    {"DistantLight", test::distant_light_scene},
    {"Spot", test::spot_scene},
};

class Proposal_LeavesTheTargetAlone : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {};

TEST_P(Proposal_LeavesTheTargetAlone, Alone) {
    const auto [kind, scene_index] = GetParam();
    const auto scene = kScenes[scene_index].make();
    const ProposalContext context{scene.get(), PathSet::stored, 8};
    Mixture<Path> mixture;
    mixture.add(proposal_kinds()[kind].make(context), 1);
    const test::Invariance result = test::measure_invariance(*scene, mixture, PathSet::stored, 120'000, 11);
    if (result.ledger.at(0).proposed < 100) GTEST_SKIP() << "next to nothing here that this kind can move";
    EXPECT_GT(result.ledger.at(0).accepted, 50u);
    // Rounding of positions may put a step outside its support: seldom.
    EXPECT_LE(result.ledger.at(0).nan * 10'000, result.ledger.at(0).proposed);
    EXPECT_LT(result.worst(), 4) << result.report();
}

INSTANTIATE_TEST_SUITE_P(Kinds, Proposal_LeavesTheTargetAlone,
                         testing::Combine(testing::Range<std::size_t>(0, proposal_kinds().size()),
                                          testing::Range<std::size_t>(0, std::size(kScenes))),
                         [](const auto& info) {
                             static const auto scene = test::diffuse_box();
                             const auto kind = proposal_kinds()[std::get<0>(info.param)].make({scene.get()});
                             return std::string(kind->name()) + "_" + kScenes[std::get<1>(info.param)].name;
                         });

} // namespace
} // namespace keyhole
