#include "photonmap/map_stores.h"

#include "core/statistics.h"
#include "photon_support.h"
#include "support/chance.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace keyhole {
namespace {

using namespace photon_test;

constexpr std::size_t kRegions = 4;

Photon photon_in(std::size_t region, double where) {
    const Vec3 p(static_cast<float>(region), static_cast<float>(where), 0);
    return {p, Vec3(0, 0, 1), Vec3(0, 0, 1), Rgb(1, 0.5, static_cast<double>(region))};
}

/// Deposits with weights over four decades, a third as much on average from region to region.
std::array<double, kRegions> fill(PhotonStore& store, int deposits) {
    Rng rng = make_rng(7);
    std::array<double, kRegions> total{};
    for (int i = 0; i < deposits; ++i) {
        const std::size_t region = rng.below(kRegions);
        const double weight = std::pow(10.0, 3 * rng.next() - 0.5 * static_cast<double>(region));
        const double where = rng.next();
        store.deposit(photon_in(region, where), weight);
        total[region] += weight;
    }
    return total;
}

TEST(PhotonStore, KeepsTheExpectationOfEveryRegionUnderItsCeiling) {
    constexpr std::size_t capacity = 100;
    constexpr double scale = 1e-3;
    for (const double initial : {0.0, 1e-6, 300.0}) {
        std::array<RunningStats, kRegions> power;
        std::array<double, kRegions> expected{};
        for (std::uint64_t seed = 0; seed < 1500; ++seed) {
            PhotonStore store(capacity, initial, make_rng(100 + seed));
            const std::size_t bytes = store.bytes();
            expected = fill(store, 100 * static_cast<int>(capacity));
            ASSERT_LE(store.size(), capacity);
            ASSERT_EQ(store.bytes(), bytes);
            const std::vector<Photon> photons = store.release(scale);
            ASSERT_LE(photons.size(), capacity);
            std::array<double, kRegions> sum{};
            for (const Photon& p : photons) sum[static_cast<std::size_t>(p.position().x)] += p.power().x;
            for (std::size_t i = 0; i < kRegions; ++i) power[i].add(sum[i]);
        }
        for (std::size_t i = 0; i < kRegions; ++i) {
            EXPECT_TRUE(test::has_mean(power[i], expected[i] * scale, kRegions)) << "region " << i;
            EXPECT_LT(power[i].standard_error(), 0.1 * power[i].mean());
        }
    }
}

TEST(PhotonStore, KeepsEverythingAsItIsWhileThereIsRoom) {
    PhotonStore store(1000, 0, make_rng(0));
    const auto expected = fill(store, 1000);
    const std::vector<Photon> photons = store.release(2);
    EXPECT_EQ(photons.size(), 1000u);
    std::array<double, kRegions> sum{};
    for (const Photon& p : photons) sum[static_cast<std::size_t>(p.position().x)] += p.power().x;
    for (std::size_t i = 0; i < kRegions; ++i) EXPECT_NEAR(sum[i], 2 * expected[i], 4e-4 * expected[i]);
    EXPECT_EQ(store.bytes(), 0u);
}

TEST(PhotonStore, SaysWhatItHoldsAndNotWhatItMay) {
    constexpr std::size_t capacity = 1000;
    PhotonStore store(capacity, 0, make_rng(0));
    EXPECT_EQ(store.bytes_held(), 0u);
    for (int i = 0; i < 10; ++i) store.deposit(photon_in(0, 0.5), 1);
    EXPECT_EQ(store.bytes_held(), 10 * PhotonStore::bytes_per_photon());
    EXPECT_EQ(store.release(1).capacity(), 10u) << "what nobody needs is given back";
    PhotonStore full(capacity, 0, make_rng(0));
    fill(full, 10 * capacity);
    EXPECT_EQ(full.bytes_held(), full.bytes()) << "they were there, before they were thinned";
}

TEST(PhotonStore, RefusesWeightsThatAreNoNumbers) {
    PhotonStore store(10, 0, make_rng(0));
    for (int i = 0; i < 100; ++i) store.deposit(photon_in(0, 0.5), std::numeric_limits<double>::infinity());
    for (int i = 0; i < 100; ++i) store.deposit(photon_in(0, 0.5), 1e60); // infinite as a float
    EXPECT_EQ(store.size(), 0u);
}

TEST(PhotonStore, UsesMostOfItsCapacityWhenItThins) {
    PhotonStore store(1000, 0, make_rng(0));
    fill(store, 100'000);
    EXPECT_GT(store.release(1).size(), 850u);
}

TEST(PhotonStore, DependsOnDepositsAndSeedAlone) {
    std::vector<Photon> photons[3];
    for (std::size_t i = 0; i < 3; ++i) {
        PhotonStore store(100, 0, make_rng(i == 2 ? 1 : 0));
        fill(store, 10'000);
        photons[i] = store.release(1);
    }
    EXPECT_EQ(photons[0], photons[1]);
    EXPECT_NE(photons[0], photons[2]);
}

/// Two parts of unlike scales, the first of which is settled before it is known what becomes of the second.
TEST(PhotonStore, KeepsTheExpectationOfBothParts) {
    constexpr double first = 2e-3, next = 5e-4, second = 7e-4;
    std::array<RunningStats, kRegions> power;
    std::array<double, kRegions> expected{};
    for (std::uint64_t seed = 0; seed < 800; ++seed) {
        PhotonStore store(100, 0, make_rng(100 + seed));
        const std::array<double, kRegions> of_first = fill(store, 2000);
        store.settle(first, next);
        const std::array<double, kRegions> of_second = fill(store, 5000);
        std::array<double, kRegions> sum{};
        for (const Photon& p : store.release(second)) sum[static_cast<std::size_t>(p.position().x)] += p.power().x;
        for (std::size_t i = 0; i < kRegions; ++i) {
            power[i].add(sum[i]);
            expected[i] = of_first[i] * first + of_second[i] * second;
        }
    }
    for (std::size_t i = 0; i < kRegions; ++i)
        EXPECT_TRUE(test::has_mean(power[i], expected[i], kRegions)) << "region " << i;
}

} // namespace
} // namespace keyhole
