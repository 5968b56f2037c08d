// How often each kind of proposal is tried, set by what it brings.
#include "core/parallel.h"
#include "sampling/brightness.h"
#include "sampling/proposals/tuning.h"
#include "support/test_scenes.h"
#include "support/user_paths.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr int kDepth = 8;

struct Tuning : testing::Test {
    std::unique_ptr<Scene> scene = test::diffuse_box();
    ProposalContext context{scene.get(), PathSet::stored, kDepth};
    Settings settings;
    std::vector<Path> paths = drawn(*scene);

    static std::vector<Path> drawn(const Scene& scene, const GuidedPaths* guides = nullptr) {
        const StageOneSettings first{.max_scatterings = kDepth, .samples = 20'000, .seed = 3, .guides = guides};
        const StageOne one = run_stage_one(scene, first, {});
        return choose_seeds(scene, first, one, one.all_groups(), 500);
    }
    /// What all kinds that a diffuse scene has get together.
    static double sum(const Settings& s) {
        return s.p_bidirectional + s.p_lens_subpath + s.p_lens_perturbation + s.p_photon_map;
    }
};

TEST_F(Tuning, SharesOutProbability) {
    const Settings tuned = tuned_proposals(context, settings, {}, paths, 7);
    EXPECT_NEAR(sum(tuned), 1, 1e-9);
    // Small steps in the image move a chain least: that is their purpose.
    EXPECT_LT(tuned.p_lens_perturbation, 0.8 * settings.p_lens_perturbation / sum(settings));
    EXPECT_GT(tuned.p_lens_subpath, 1.5 * settings.p_lens_subpath / sum(settings));
}

TEST_F(Tuning, LeavesSettingsAloneThatItCannotJudge) {
    const auto unchanged = [&](const Settings& s, std::span<const Path> some) {
        return sum(tuned_proposals(context, s, {}, some, 7)) == sum(s);
    };
    EXPECT_TRUE(unchanged(settings, {}));
    settings.mutations = 1000;
    EXPECT_TRUE(unchanged(settings, paths));
    settings = {};
    settings.tune_proposals = false;
    EXPECT_TRUE(unchanged(settings, paths));
}

TEST_F(Tuning, GivesNothingToKindsThatAreLeftOutAndLessToUselessOnes) {
    settings.plan = "all"; // which has caustic perturbations where there are no caustics
    settings.p_lens_subpath = 0;
    const double given = sum(settings) + settings.p_caustic_perturbation + settings.p_multi_chain_perturbation;
    const Settings tuned = tuned_proposals(context, settings, {}, paths, 7);
    EXPECT_EQ(tuned.p_lens_subpath, 0);
    EXPECT_DOUBLE_EQ(tuned.p_caustic_perturbation, 0.5 * settings.p_caustic_perturbation / given);
}

TEST_F(Tuning, FollowsUserPathsThatHelp) {
    constexpr float kSlit = 0.03f;
    const auto rooms = test::two_rooms(kSlit);
    const UserPaths along = test::bounces_through(*rooms, kSlit, kDepth - 1);
    const GuidedPaths guides(*rooms, along, PathSet::stored, kDepth);
    const Settings tuned =
        tuned_proposals({rooms.get(), PathSet::stored, kDepth}, settings, along, drawn(*rooms, &guides), 7);
    EXPECT_GT(tuned.p_guided_path, 0.3);
    EXPECT_LT(tuned.p_user_path, 0.1 * tuned.p_guided_path);
}

TEST_F(Tuning, IsTheSameOnAnyNumberOfThreads) {
    Settings alone, together;
    with_threads(1, [&] { alone = tuned_proposals(context, settings, {}, paths, 7); });
    with_threads(4, [&] { together = tuned_proposals(context, settings, {}, paths, 7); });
    EXPECT_EQ(alone.p_bidirectional, together.p_bidirectional);
    EXPECT_EQ(alone.p_lens_subpath, together.p_lens_subpath);
    EXPECT_EQ(alone.p_lens_perturbation, together.p_lens_perturbation);
}

} // namespace
} // namespace keyhole
