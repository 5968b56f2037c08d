// The agreement of chains: synthetic series, and a render that is deliberately too short.
#include "sampling/markov/convergence.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "methods/render.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gmock/gmock.h>

#include <limits>

namespace keyhole {
namespace {

using Series = std::vector<std::vector<double>>;

/// `draw(series, i, noise)` with noise uniform in [-1, 1).
template <class Draw> Series make_series(int count, int length, Draw&& draw) {
    Rng rng(3, StreamPurpose::test, 0);
    Series all(static_cast<std::size_t>(count));
    for (int s = 0; s < count; ++s)
        for (int i = 0; i < length; ++i) all[static_cast<std::size_t>(s)].push_back(draw(s, i, 2 * rng.next() - 1));
    return all;
}

TEST(SplitRHat, IsOneForSeriesThatAgree) {
    EXPECT_NEAR(split_r_hat(make_series(8, 2000, [](int, int, double e) { return 5 + e; })), 1, 0.003);
    EXPECT_LT(split_r_hat(make_series(8, 16, [](int, int, double e) { return 5 + e; })), 1.15);
    EXPECT_EQ(split_r_hat(make_series(8, 16, [](int, int, double) { return 5; })), 1);
}

TEST(SplitRHat, SeesSeriesThatDisagree) {
    EXPECT_GT(split_r_hat(make_series(8, 200, [](int s, int, double e) { return s + e; })), 2);
    EXPECT_EQ(split_r_hat(make_series(8, 16, [](int s, int, double) { return s; })),
              std::numeric_limits<double>::infinity());
}

// All series do the same, so that only the halves of each can tell.
TEST(SplitRHat, SeesSeriesThatDriftTogether) {
    EXPECT_GT(split_r_hat(make_series(8, 200, [](int, int i, double e) { return 0.02 * i + e; })), 1.5);
}

TEST(SplitRHat, KnowsItsClosedForm) {
    // Halves {0, 2}, {4, 6}, {0, 2}, {4, 6}: variance 2 within, variance of the means 16/3.
    const Series series{{0, 2, 4, 6}, {0, 2, 4, 6}};
    EXPECT_NEAR(split_r_hat(series), std::sqrt(0.5 + 16.0 / 3 / 2), 1e-12);
    // The first draw of an odd number is left out.
    const Series odd{{9, 0, 2, 4, 6}, {9, 0, 2, 4, 6}};
    EXPECT_EQ(split_r_hat(odd), split_r_hat(series));
}

/// 64 chains over `rounds` rounds of `steps`; where(chain, round) is where one deposits.
template <class Where> std::optional<ConvergenceDiagnostic> watch(int rounds, int steps, Where&& where) {
    ConvergenceMonitor monitor;
    for (int r = 0; r < rounds; ++r) {
        parallel_for(64, [&](std::int64_t c) {
            Rng rng(7, StreamPurpose::test, static_cast<std::uint64_t>(64 * r + c));
            for (int i = 0; i < steps; ++i) monitor.add(c, where(c, r, rng), 1);
        });
        monitor.end_round(steps);
    }
    return monitor.diagnostic();
}

Vec2 anywhere(Rng& rng) { return {static_cast<float>(rng.next()), static_cast<float>(rng.next())}; }

TEST(ConvergenceMonitor, TrustsChainsThatMixAndNamesTheirError) {
    for (const int rounds : {8, 31, 32, 33, 100, 500}) {
        const auto a = watch(rounds, 20, [](std::int64_t, int, Rng& rng) { return anywhere(rng); });
        ASSERT_TRUE(a);
        EXPECT_LT(a->r_hat, 1.7) << rounds; // of 36 blocks the worst
        // Binomial: 36 blocks share rounds * 64 * 20 draws; the mean of |z| is not wanted, its root mean square is.
        EXPECT_NEAR(a->error, std::sqrt(35.0 / (rounds * 64 * 20)), 0.25 * a->error) << rounds;
    }
}

TEST(ConvergenceMonitor, DistrustsChainsThatStayWhereTheyWere) {
    const auto a = watch(100, 20, [](std::int64_t c, int, Rng&) {
        Rng own(8, StreamPurpose::test, static_cast<std::uint64_t>(c));
        return anywhere(own);
    });
    ASSERT_TRUE(a);
    EXPECT_GT(a->r_hat, 10);
    EXPECT_GT(a->error, 0.3);
}

TEST(ConvergenceMonitor, SaysNothingOfAFewRounds) {
    EXPECT_FALSE(watch(3, 1, [](std::int64_t, int, Rng& rng) { return anywhere(rng); }));
    EXPECT_FALSE(ConvergenceMonitor().diagnostic());
}

class Chains_RaiseTheAlarm : public testing::TestWithParam<const char*> {};

TEST_P(Chains_RaiseTheAlarm, WhenTooShortOnly) {
    const auto scene = test::diffuse_box();
    Settings settings = test::settings_from("spp=1 brightness_samples=20k importons=5k photons=5k chains=64");
    settings.method = &method_named(GetParam());
    settings.mutations = 64 * 40;
    EXPECT_THAT(render(*scene, settings, {}).stats.warnings, testing::Contains(testing::HasSubstr("can't be trusted")));
    settings.mutations = 64 * 2;
    EXPECT_THAT(render(*scene, settings, {}).stats.warnings, testing::Contains(testing::HasSubstr("too few to tell")));
    settings.mutations = 64 * 2'000;
    const RenderStats good = render(*scene, settings, {}).stats;
    EXPECT_THAT(good.warnings, testing::Not(testing::Contains(testing::HasSubstr("can't be trusted"))))
        << good.agreement->r_hat << " " << good.agreement->error;
}

INSTANTIATE_TEST_SUITE_P(Methods, Chains_RaiseTheAlarm, testing::Values("mps", "mlt"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
