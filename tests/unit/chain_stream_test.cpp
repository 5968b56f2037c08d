#include "sampling/markov/chain_set.h"

#include "core/statistics.h"
#include "support/chance.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace keyhole {
namespace {

constexpr int kCells = 8;

std::size_t cell(const std::array<double, 2>& p) {
    return static_cast<std::size_t>(static_cast<int>(p[1] * kCells) * kCells + static_cast<int>(p[0] * kCells));
}

TEST(ChainStream, SpreadsThePointsOfAllChainsEvenly) {
    std::vector<ChainStream> chains;
    for (std::uint64_t c = 0; c < 640; ++c) chains.emplace_back(5, c);
    for (int k = 0; k < 20; ++k) {
        std::array<int, kCells * kCells> count{};
        for (ChainStream& chain : chains) ++count.at(cell(chain.next_point()));
        EXPECT_GE(*std::min_element(count.begin(), count.end()), 7); // 10 each; a Poisson count falls below in 13 %
        EXPECT_LE(*std::max_element(count.begin(), count.end()), 13);
    }
}

// What a chain draws must tell nothing of what it draws next.
TEST(ChainStream, GivesEachChainIndependentUniformPoints) {
    constexpr int n = 64'000;
    ChainStream chain(5, 3);
    std::array<int, kCells * kCells> count{};
    RunningStats product;
    std::array<double, 2> last = chain.next_point();
    for (int k = 0; k < n; ++k) {
        const auto p = chain.next_point();
        ++count.at(cell(p));
        product.add((p[0] - 0.5) * (last[0] - 0.5) + (p[1] - 0.5) * (last[1] - 0.5));
        last = p;
    }
    double chi_squared = 0;
    for (const int c : count) chi_squared += (c - n / 64.0) * (c - n / 64.0) / (n / 64.0);
    EXPECT_LT(chi_squared, 112); // 63 degrees of freedom: above in 1 of 10,000 runs
    EXPECT_TRUE(test::has_mean(product, 0));
}

TEST(ChainStream, AgreesWithItsRngButForPoints) {
    ChainStream chain(9, 4);
    Rng rng(9, StreamPurpose::chain, 8);
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(chain.next(), rng.next());
        chain.next_point();
    }
}

} // namespace
} // namespace keyhole
