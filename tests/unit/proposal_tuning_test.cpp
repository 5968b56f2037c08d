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
        double sum = 0;
        for (const ProposalKind* kind : proposal_kinds())
            if (!kind->needs_specular && !kind->needs_user_paths) sum += s.proposals[kind->weight];
        return sum;
    }
};

TEST_F(Tuning, SharesOutProbability) {
    const Settings tuned = tuned_proposals(context, settings, paths, 7);
    EXPECT_NEAR(sum(tuned), 1, 1e-9);
    // Small steps in the image move a chain least: that is their purpose.
    EXPECT_LT(tuned.proposals[proposals::lens_perturbation.weight],
              0.8 * settings.proposals[proposals::lens_perturbation.weight] / sum(settings));
    EXPECT_GT(tuned.proposals[proposals::lens_subpath.weight],
              1.5 * settings.proposals[proposals::lens_subpath.weight] / sum(settings));
}

TEST_F(Tuning, LeavesSettingsAloneThatItCannotJudge) {
    const auto unchanged = [&](const Settings& s, std::span<const Path> some) {
        return sum(tuned_proposals(context, s, some, 7)) == sum(s);
    };
    EXPECT_TRUE(unchanged(settings, {}));
    settings.mutations = 1000;
    EXPECT_TRUE(unchanged(settings, paths));
    settings = {};
    settings.tune_proposals = false;
    EXPECT_TRUE(unchanged(settings, paths));
}

TEST_F(Tuning, GivesNothingToKindsThatAreLeftOutAndLessToUselessOnes) {
    settings.plan = Plan::all; // which has caustic perturbations where there are no caustics
    settings.proposals[proposals::lens_subpath.weight] = 0;
    const double given = sum(settings) + settings.proposals[proposals::caustic_perturbation.weight] +
                         settings.proposals[proposals::multi_chain_perturbation.weight];
    const Settings tuned = tuned_proposals(context, settings, paths, 7);
    EXPECT_EQ(tuned.proposals[proposals::lens_subpath.weight], 0);
    EXPECT_DOUBLE_EQ(tuned.proposals[proposals::caustic_perturbation.weight],
                     0.5 * settings.proposals[proposals::caustic_perturbation.weight] / given);
}

TEST_F(Tuning, FollowsUserPathsThatHelp) {
    constexpr float kSlit = 0.03f;
    const auto rooms = test::two_rooms(kSlit);
    const UserPaths along = test::bounces_through(*rooms, kSlit, kDepth - 1);
    const GuidedPaths guides(*rooms, along, PathSet::stored, kDepth);
    const Settings tuned =
        tuned_proposals({rooms.get(), PathSet::stored, kDepth, &along}, settings, drawn(*rooms, &guides), 7);
    EXPECT_GT(tuned.proposals[proposals::guided_path.weight], 0.3);
    EXPECT_LT(tuned.proposals[proposals::user_path.weight], 0.1 * tuned.proposals[proposals::guided_path.weight]);
}

TEST_F(Tuning, IsTheSameOnAnyNumberOfThreads) {
    Settings alone, together;
    with_threads(1, [&] { alone = tuned_proposals(context, settings, paths, 7); });
    with_threads(4, [&] { together = tuned_proposals(context, settings, paths, 7); });
    EXPECT_EQ(alone.proposals[proposals::bidirectional.weight], together.proposals[proposals::bidirectional.weight]);
    EXPECT_EQ(alone.proposals[proposals::lens_subpath.weight], together.proposals[proposals::lens_subpath.weight]);
    EXPECT_EQ(alone.proposals[proposals::lens_perturbation.weight],
              together.proposals[proposals::lens_perturbation.weight]);
}

} // namespace
} // namespace keyhole
