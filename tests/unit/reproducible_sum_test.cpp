// Sums that don't depend on the order or the grouping of their terms.
#include "core/reproducible_sum.h"

#include "core/rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

namespace keyhole {
namespace {

using Sum = ReproducibleSums<1>;
using ShortSum = ReproducibleSums<1, std::int32_t, 12>;

/// Numbers of either sign, of sizes from 2^-spread to 2^spread.
std::vector<double> numbers(int count, int spread, bool is_signed) {
    Rng rng(1, StreamPurpose::test, static_cast<std::uint64_t>(spread));
    std::vector<double> all;
    for (int i = 0; i < count; ++i) {
        const double x = std::exp2(spread * (2 * rng.next() - 1)) * (1 + rng.next());
        all.push_back(is_signed && rng.next() < 0.5 ? -x : x);
    }
    return all;
}

/// The sum by `groups` shares that are merged in the order of their numbers, or the reverse.
template <class Sum> Sum grouped(const std::vector<double>& terms, std::size_t groups, bool reverse) {
    std::vector<Sum> shares(groups);
    for (std::size_t i = 0; i < terms.size(); ++i) shares[i % groups].add(0, terms[i]);
    if (reverse) std::ranges::reverse(shares);
    Sum all;
    for (const Sum& s : shares) all.merge(s);
    return all;
}

template <class Sum> bool same(const Sum& a, const Sum& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

} // namespace

template <class Sum> class ReproducibleSum_OfShuffledAndGroupedTerms : public testing::Test {};
using Sums = testing::Types<Sum, ShortSum>;
TYPED_TEST_SUITE(ReproducibleSum_OfShuffledAndGroupedTerms, Sums);

TYPED_TEST(ReproducibleSum_OfShuffledAndGroupedTerms, IsTheSameBitForBit) {
    for (const int spread : {1, 20, 40, 200, 950}) {
        for (const bool is_signed : {false, true}) {
            std::vector<double> terms = numbers(500, spread, is_signed);
            terms.push_back(0);
            const TypeParam first = grouped<TypeParam>(terms, 1, false);
            for (const std::size_t groups : {2, 7, 100}) {
                EXPECT_TRUE(same(first, grouped<TypeParam>(terms, groups, false))) << spread << " " << groups;
                EXPECT_TRUE(same(first, grouped<TypeParam>(terms, groups, true))) << spread << " " << groups;
            }
            std::ranges::sort(terms);
            EXPECT_TRUE(same(first, grouped<TypeParam>(terms, 3, false))) << spread;
        }
    }
}

TEST(ReproducibleSum_OfTerms, LosesLessThanItPromises) {
    for (const int spread : {0, 3, 12, 25}) {
        const std::vector<double> terms = numbers(10'000, spread, false);
        const long double exact = std::accumulate(terms.begin(), terms.end(), 0.0L);
        const double largest = *std::ranges::max_element(terms);
        EXPECT_NEAR(grouped<Sum>(terms, 5, false).value(0), static_cast<double>(exact), 10'000 * 0x1p-32 * largest);
        EXPECT_NEAR(grouped<ShortSum>(terms, 5, false).value(0), static_cast<double>(exact),
                    10'000 * 0x1p-12 * largest);
    }
}

TEST(ReproducibleSum_OfShortNumbers, IsExact) {
    Sum sum;
    for (int i = 0; i < 3; ++i) sum.add(0, 0.375);
    sum.add(0, -1e6);
    EXPECT_EQ(sum.value(0), 1.125 - 1e6);
    EXPECT_EQ(Sum().value(0), 0);
}

} // namespace keyhole
