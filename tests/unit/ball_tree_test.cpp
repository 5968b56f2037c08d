// Balls along a ray: all of them, and no other.
#include "core/rng.h"
#include "sampling/guidance/learned/ball_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace keyhole {
namespace {

std::vector<Ball> scattered_balls(int n, float scale) {
    Rng rng(3, StreamPurpose::test, 0);
    const auto number = [&] { return scale * static_cast<float>(2 * rng.next() - 1); };
    std::vector<Ball> balls;
    for (int i = 0; i < n; ++i) {
        const Vec3 center(number(), number(), number());
        balls.push_back({center, scale * static_cast<float>(1e-4 + 0.2 * rng.next() * rng.next())});
    }
    return balls;
}

/// Against the test of each ball by itself.
void expect_all(const BallTree& tree, const Vec3& origin, const Vec3& w) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < tree.balls().size(); ++i)
        if (passes(tree.balls()[i], origin, w)) expected.push_back(i);
    const auto found = tree.along(origin, w);
    EXPECT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()), expected);
}

TEST(BallTree, FindsWhatARayPassesThrough) {
    for (const float scale : {1e-2f, 1.0f, 1e3f}) {
        const BallTree tree(scattered_balls(2000, scale));
        Rng rng(4, StreamPurpose::test, 0);
        const auto number = [&] { return static_cast<float>(2 * rng.next() - 1); };
        std::size_t found = 0;
        for (int i = 0; i < 500; ++i) {
            const Vec3 w = Vec3(number(), number(), number()).normalized();
            // From among them, and from far away.
            const Vec3 at = Vec3(number(), number(), number()) * scale;
            expect_all(tree, at, w);
            expect_all(tree, at - w * (50 * scale), w);
            found += tree.along(at, w).size();
        }
        EXPECT_GT(found, 1000);
    }
}

TEST(BallTree, CountsTheBallThatARayBeginsInAndNoneBehindIt) {
    const BallTree tree({{{0, 0, 0}, 1}, {{0, 0, -5}, 1}, {{0, 0, 5}, 1}});
    const auto found = tree.along({0, 0.5f, 0.2f}, {0, 0, 1});
    EXPECT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()), (std::vector<std::uint32_t>{0, 2}));
    EXPECT_TRUE(BallTree().along({0, 0, 0}, {0, 0, 1}).empty());
}

TEST(BallTree, TellsKindsApart) {
    const std::vector<Ball> balls = scattered_balls(300, 1);
    std::vector<std::uint32_t> kinds;
    for (std::size_t i = 0; i < balls.size(); ++i) kinds.push_back(i % 7 == 0 ? 3 : 90'000);
    const BallTree tree(balls, kinds);
    const BallTree all(balls);
    Rng rng(5, StreamPurpose::test, 0);
    const auto number = [&] { return static_cast<float>(2 * rng.next() - 1); };
    for (int i = 0; i < 100; ++i) {
        const Vec3 w = Vec3(number(), number(), number()).normalized();
        for (const std::uint32_t kind : {3u, 90'000u}) {
            std::vector<std::uint32_t> expected;
            for (const std::uint32_t ball : all.along({0, 0, 0}, w))
                if (kinds[ball] == kind) expected.push_back(ball);
            const auto found = tree.along({0, 0, 0}, w, kind);
            EXPECT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()), expected);
        }
        EXPECT_TRUE(tree.along({0, 0, 0}, w, 4).empty());
    }
}

} // namespace
} // namespace keyhole
