// User paths, with bidirectional proposals beside them and without: one step leaves the target alone, and mistakes in
// their densities are noticed.
#include "sampling/guidance/guided_paths.h"
#include "sampling/proposals/edit.h"
#include "support/invariance.h"
#include "support/test_scenes.h"
#include "support/user_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace keyhole {
namespace {

/// Proposals along user paths, UP or UI, with probability `share`, BD otherwise.
Mixture<Path> guided(const ProposalContext& context, const UserPaths& paths, const ProposalKind& proposal,
                     double share) {
    Settings settings;
    for (const ProposalKind* kind : proposal_kinds()) settings.proposals[kind->weight] = 0;
    settings.proposals[proposals::bidirectional.weight] = 1 - share;
    settings.proposals[proposal.weight] = share;
    return make_mixture({context.scene, context.set, context.max_scatterings, &paths}, settings);
}

/// Accepted candidates of the kinds from `first` on.
std::uint64_t accepted(const Ledger& ledger, std::size_t first) {
    std::uint64_t n = 0;
    for (std::size_t k = first; k < ledger.size(); ++k) n += ledger[k].accepted;
    return n;
}

/// A way to follow user paths.
struct Follow {
    const char* name;
    const ProposalKind* proposal;
    Technique technique; ///< what the paths that it moves are drawn by
};
constexpr Follow kFollow[] = {{"", &proposals::user_path, Technique::path},
                              {"Independent", &proposals::guided_path, Technique::bidirectional}};

class UserPaths_LeaveTheTargetAlone : public testing::TestWithParam<std::tuple<std::size_t, double, Follow>> {};

TEST_P(UserPaths_LeaveTheTargetAlone, AtShare) {
    const auto [index, share, follow] = GetParam();
    const auto scene = test::guided_scenes()[index].make();
    const UserPaths paths = bind_user_paths(*scene, test::guided_scenes()[index].paths(*scene));
    const auto mixture = guided({scene.get(), PathSet::stored, 8}, paths, *follow.proposal, share);
    const test::Invariance result =
        test::measure_invariance(*scene, mixture, PathSet::stored, 120'000, 23, 8, follow.technique);
    EXPECT_GT(accepted(result.ledger, share < 1 ? 1 : 0), 10u) << result.report();
    EXPECT_LE(result.worst(), test::Invariance::bound()) << result.report();
}

INSTANTIATE_TEST_SUITE_P(Shares, UserPaths_LeaveTheTargetAlone,
                         testing::Combine(testing::Range<std::size_t>(0, test::guided_scenes().size()),
                                          testing::Values(0.5, 1.0), testing::ValuesIn(kFollow)),
                         [](const auto& info) {
                             return std::string(test::guided_scenes()[std::get<0>(info.param)].name) +
                                    (std::get<1>(info.param) < 1 ? "_Half" : "_Alone") + std::get<2>(info.param).name;
                         });

/// User paths with a mistake in their densities: proposes by `right`, judges by what `density` says.
class Mistaken final : public Proposal<Path> {
  public:
    /// The density of x -> y where `reverse` tells which way it is asked for.
    using Density = std::function<double(const Path& x, const Path& y, bool reverse)>;
    Mistaken(PathProposal right, Density density) : right_(std::move(right)), density_(std::move(density)) {}

    std::string_view name() const override { return right_->name(); }
    double suitability(const Path& x) const override { return right_->suitability(x); }
    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override {
        start() = x;
        return right_->propose(x, rng, why);
    }
    double transition_density(const Path& x, const Path& y) const override {
        const bool forward = x.vertices() == start().vertices() && common_prefix(x, start()) == x.vertices();
        return density_(x, y, !forward);
    }

  private:
    /// What this thread's chain is about to leave.
    static Path& start() {
        static thread_local Path path;
        return path;
    }
    PathProposal right_;
    Density density_;
};

PathProposal only_one(const ProposalKind& kind, const ProposalContext& context) {
    return std::move(kind.make(context).front().proposal);
}

/// UP along one user path.
PathProposal along(const ProposalContext& context, const UserPath& path) {
    const UserPaths alone{path};
    return only_one(proposals::user_path, {context.scene, context.set, context.max_scatterings, &alone});
}

UserPaths with_beta(UserPaths paths, double factor) {
    for (UserPath& path : paths)
        for (UserVertex& v : path.vertices) v.beta *= factor;
    return paths;
}

/// Every user path alone in its own cone, as `density` judges it from the right densities of all of them.
class UserPaths_NoticeAMistake : public testing::Test {
  protected:
    /// Density of the move x -> y by user path i; `reverse`: the way back is asked for.
    using Density = std::function<double(std::size_t i, const Path& x, const Path& y, bool reverse)>;

    test::Invariance measure(const UserPaths& paths, const Density& density, double bidirectional = 0) const {
        Mixture<Path> mixture;
        for (std::size_t i = 0; i < paths.size(); ++i)
            mixture.add(std::make_unique<Mistaken>(
                            along(context, paths[i]),
                            [=](const Path& x, const Path& y, bool reverse) { return density(i, x, y, reverse); }),
                        1, family);
        mixture.add(only_one(proposals::bidirectional, context), bidirectional, family);
        return test::measure_invariance(*scene, mixture, PathSet::stored, 120'000, 29);
    }
    int family = 0;
    std::unique_ptr<Scene> scene = test::diffuse_box();
    ProposalContext context{scene.get(), PathSet::stored, 8};
    UserPaths paths = with_beta(bind_user_paths(*scene, test::diffuse_box_paths(*scene)), 1.2);
};

/// Densities of each of `paths`.
std::vector<std::shared_ptr<const Proposal<Path>>> proposals(const ProposalContext& context, const UserPaths& paths) {
    std::vector<std::shared_ptr<const Proposal<Path>>> all;
    for (const UserPath& path : paths) all.push_back(along(context, path));
    return all;
}

TEST_F(UserPaths_NoticeAMistake, NotWhereThereIsNone) {
    const auto right = proposals(context, paths);
    const auto result = measure(
        paths, [&](std::size_t i, const Path& x, const Path& y, bool) { return right[i]->transition_density(x, y); });
    EXPECT_LE(result.worst(), test::Invariance::bound()) << result.report();
}

TEST_F(UserPaths_NoticeAMistake, BetaTwiceAsLargeInTheReverse) {
    const auto right = proposals(context, paths), wide = proposals(context, with_beta(paths, 2));
    const auto result = measure(paths, [&](std::size_t i, const Path& x, const Path& y, bool reverse) {
        return (reverse ? wide : right)[i]->transition_density(x, y);
    });
    EXPECT_GT(result.worst(), test::Invariance::bound()) << result.report();
}

TEST_F(UserPaths_NoticeAMistake, SumOverOnlyOneUserPath) {
    const auto right = proposals(context, paths);
    const auto result = measure(paths, [&](std::size_t i, const Path& x, const Path& y, bool) {
        return i == 0 ? right[0]->transition_density(x, y) : 0.0;
    });
    EXPECT_GT(result.worst(), test::Invariance::bound()) << result.report();
}

TEST_F(UserPaths_NoticeAMistake, OnlyTheUserPathThatWasChosen) {
    // Right for kinds that are judged one by one: the sum buys acceptance, not correctness.
    const auto right = proposals(context, paths);
    family = Mixture<Path>::kAlone;
    const auto result = measure(
        paths, [&](std::size_t i, const Path& x, const Path& y, bool) { return right[i]->transition_density(x, y); });
    EXPECT_LE(result.worst(), test::Invariance::bound()) << result.report();
}

TEST_F(UserPaths_NoticeAMistake, PatchLeftOut) {
    // Among user paths of one patch a constant factor cancels; beside bidirectional proposals it does not.
    const auto right = proposals(context, paths);
    const auto result = measure(
        paths,
        [&](std::size_t i, const Path& x, const Path& y, bool) {
            const double density = right[i]->transition_density(x, y);
            return density > 0 ? density / paths[i].patch.pdf(y.x[0].point) : 0.0;
        },
        3);
    EXPECT_GT(result.worst(), test::Invariance::bound()) << result.report();
}

TEST_F(UserPaths_NoticeAMistake, IndependentPathsThatAreDrawnLonger) {
    const GuidedPaths guides(*scene, paths, context.set, context.max_scatterings);
    Mixture<Path> mixture;
    const auto density = [&](const Path&, const Path& y, bool) {
        return guides.draw_density(y) * std::pow(0.9, y.vertices());
    };
    mixture.add(
        std::make_unique<Mistaken>(
            only_one(proposals::guided_path, {scene.get(), context.set, context.max_scatterings, &paths}), density),
        1);
    const auto result = test::measure_invariance(*scene, mixture, PathSet::stored, 120'000, 29);
    EXPECT_GT(result.worst(), test::Invariance::bound()) << result.report();
}

} // namespace
} // namespace keyhole
