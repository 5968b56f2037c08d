#include "photonmap/outlying_photons.h"

#include "core/rng.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr int kNearest = 60;
constexpr float kMostRadius = 0.1f, kPower = 1;

Photon photon_at(float x, float y, double power) { return {Vec3(x, y, 0), Vec3(0, 0, 1), Vec3(0, 0, 1), Rgb(power)}; }

/// Photons spread evenly over a square of 2 m.
PhotonSet even_photons(int count, std::uint64_t seed) {
    PhotonSet set;
    Rng rng(seed, StreamPurpose::test, 0);
    for (int i = 0; i < count; ++i) {
        const auto x = static_cast<float>(2 * rng.next() - 1), y = static_cast<float>(2 * rng.next() - 1);
        (i % kPilotEvery == 0 ? set.pilots : set.main_photons).push_back(photon_at(x, y, kPower));
    }
    return set;
}

TEST(OutlyingPhotons, AreNoneAmongEvenOnes) {
    PilotedMap map(even_photons(20'000, 1));
    const std::size_t before = map.main_photons().photons().size();
    const OutlyingPhotons outlying(map, kNearest, kMostRadius, 1, nullptr);
    EXPECT_EQ(outlying.size(), 0u);
    EXPECT_EQ(map.main_photons().photons().size(), before);
}

TEST(OutlyingPhotons, AreNoneInACausticThatPilotPhotonsConfirm) {
    PhotonSet set = even_photons(4000, 2);
    Rng rng(3, StreamPurpose::test, 0);
    for (int i = 0; i < 400; ++i) {
        const Photon p = photon_at(static_cast<float>(0.004 * rng.next()), static_cast<float>(0.004 * rng.next()), 1);
        (i % kPilotEvery == 0 ? set.pilots : set.main_photons).push_back(p);
    }
    PilotedMap map(std::move(set));
    EXPECT_EQ(OutlyingPhotons(map, kNearest, kMostRadius, 1, nullptr).size(), 0u);
}

/// With the lone photon of great power `power` in the middle: how bright that is there, and all of it.
struct Lone {
    double in_the_middle = 0; ///< [W/m^2]
    double power = 0;         ///< that all regions of lookups get [W]
    double reach = 0;         ///< [m]
};
Lone lone_photon(PhotonSet set, double power) {
    set.main_photons.push_back(photon_at(0, 0, power));
    PilotedMap map(std::move(set));
    const OutlyingPhotons outlying(map, kNearest, kMostRadius, 1, nullptr);
    EXPECT_EQ(outlying.size(), 1u);
    Lone lone;
    constexpr int n = 200;
    constexpr double step = 2.0 / n;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const Vec3 p(static_cast<float>((i + 0.5) * step - 1), static_cast<float>((j + 0.5) * step - 1), 0);
            outlying.for_each_reaching({p, Vec3(0, 0, 1)}, [&](const Photon& photon, const OutlyingPhotons::Lit& lit) {
                const double light = photon.power().x / lit.area;
                lone.in_the_middle = std::max(lone.in_the_middle, light);
                lone.power += light * step * step;
                lone.reach = std::max(lone.reach, static_cast<double>(p.length()));
            });
        }
    }
    return lone;
}

TEST(OutlyingPhotons, LightAsMuchSurfaceAsMakesThemNoBrighterThanTheOthers) {
    constexpr int count = 20'000;
    const double others = 0.75 * count * kPower / 4; // [W/m^2]
    const Lone lone = lone_photon(even_photons(count, 4), 400 * kPower);
    EXPECT_LT(lone.in_the_middle, 1.5 * others);
    EXPECT_NEAR(lone.power, 400 * kPower, 0.03 * 400);
}

TEST(OutlyingPhotons, InTheDarkLightFourTimesTheRadiusOfALookup) {
    const Lone lone = lone_photon({}, kPower);
    EXPECT_NEAR(lone.reach, 4 * kMostRadius, 0.02);
    EXPECT_NEAR(lone.power, kPower, 0.03);
}

} // namespace
} // namespace keyhole
