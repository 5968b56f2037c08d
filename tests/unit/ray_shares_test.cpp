#include "gather/ray_shares.h"

#include "core/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace keyhole {
namespace {

TEST(RayShares, SpendWhatThereIsInProportion) {
    Rng rng(1, StreamPurpose::test, 0);
    std::vector<double> weights(1000);
    for (double& weight : weights) weight = std::exp(4 * rng.next());
    const std::vector<int> rays = share_rays(weights, 20, 180);
    ASSERT_EQ(rays.size(), weights.size());
    EXPECT_NEAR(std::accumulate(rays.begin(), rays.end(), 0.0), 200.0 * 1000, 500) << "a half for each, by rounding";
    double per_worth = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_GE(rays[i], 20) << "what it had";
        if (rays[i] <= 20) continue;
        if (per_worth == 0) per_worth = rays[i] / weights[i];
        EXPECT_NEAR(rays[i] / weights[i], per_worth, 1 / weights[i] + per_worth / 20);
    }
    EXPECT_GT(per_worth, 0) << "none got more";
}

TEST(RayShares, AreLeastWrongSo) {
    // Any other way to spend as many rays has a larger sum of weight^2 / rays.
    const std::vector<double> weights{1, 2, 5, 9, 30};
    const std::vector<int> rays = share_rays(weights, 10, 190);
    const auto error = [&](const std::vector<int>& n) {
        double sum = 0;
        for (std::size_t i = 0; i < n.size(); ++i) sum += weights[i] * weights[i] / n[i];
        return sum;
    };
    for (std::size_t from = 0; from < rays.size(); ++from)
        for (std::size_t to = 0; to < rays.size(); ++to) {
            std::vector<int> other = rays;
            other[from] -= 8;
            other[to] += 8;
            if (from == to || other[from] < 10) continue;
            EXPECT_GT(error(other), error(rays)) << from << " to " << to;
        }
}

TEST(RayShares, HaveBounds) {
    EXPECT_TRUE(share_rays({}, 10, 100).empty());
    EXPECT_EQ(share_rays(std::vector<double>{0, 0}, 10, 100), (std::vector{10, 10})) << "nothing is weight more";
    EXPECT_EQ(share_rays(std::vector<double>{0, 1}, 10, 0), (std::vector{10, 10})) << "nothing to share out";
    EXPECT_EQ(share_rays(std::vector<double>(3, 1.0), 10, 1e9), (std::vector{640, 640, 640}));
    // One that is weight almost everything.
    EXPECT_EQ(share_rays(std::vector<double>{1e30, 1, 1, 1}, 10, 100).front(), 410);
}

} // namespace
} // namespace keyhole
