// Sums over photons from a few of them.
#include "photonmap/few_photons.h"

#include "photon_support.h"

#include <array>

namespace keyhole {
namespace {

using namespace photon_test;

constexpr SurfaceRegion kMiddle{{0.5f, 0.5f, 0}, {0, 0, 1}};

/// So many photons on the unit square whose powers differ by up to 1000.
PhotonMap unequal_photons(int n) {
    Rng rng = make_rng(1);
    std::vector<Photon> photons = throw_photons(kUnitSquare, n, rng);
    for (Photon& p : photons) p.set_power(Rgb(std::pow(10.0, 3 * rng.next())));
    return PhotonMap(std::move(photons));
}

double power(const Photon& p) { return luminance(p.power()); }

/// Light that has nothing to do with power but for being none where that is none.
Rgb light(const Photon& p) { return Rgb(0.5 + p.position().x, 1 + p.position().y, p.position().x > 0.5f ? 1.0 : 0.0); }

Rgb whole_sum(const PhotonMap& map) {
    Rgb sum(0.0);
    map.for_each_within(kMiddle, 0.4f, [&](const Photon& p) { sum += light(p); });
    return sum;
}

TEST(FewPhotons, HaveTheSumOfAllOnAverage) {
    const PhotonMap map = unequal_photons(300);
    const Rgb expected = whole_sum(map);
    Rng rng = make_rng(2);
    for (const int few : {1, 4, 16, 64}) {
        SCOPED_TRACE(few);
        std::array<RunningStats, 3> found;
        for (int i = 0; i < 200'000; ++i) {
            const Rgb sum = sum_over_few(map, {kMiddle, 0.4f, few}, power, light, rng);
            for (std::size_t c = 0; c < 3; ++c) found[c].add(sum[static_cast<int>(c)]);
        }
        for (std::size_t c = 0; c < 3; ++c) expect_mean(found[c], expected[static_cast<int>(c)]);
    }
}

TEST(FewPhotons, AreExactWhereLightIsWhatTheyAreDrawnBy) {
    const PhotonMap map = unequal_photons(300);
    double expected = 0;
    map.for_each_within(kMiddle, 0.4f, [&](const Photon& p) { expected += power(p); });
    Rng rng = make_rng(3);
    for (int i = 0; i < 100; ++i) {
        const Rgb sum = sum_over_few(
            map, {kMiddle, 0.4f, 8}, power, [](const Photon& p) { return p.power(); }, rng);
        EXPECT_NEAR(luminance(sum), expected, 1e-9 * expected);
    }
}

TEST(FewPhotons, AreAllOfThemWhereThereAreNoMore) {
    const PhotonMap map = unequal_photons(10);
    Rng rng = make_rng(4);
    EXPECT_EQ(sum_over_few(map, {kMiddle, 0.4f, 10}, power, light, rng), whole_sum(map));
    EXPECT_EQ(sum_over_few(map, {kMiddle, 0.0f, 10}, power, light, rng), Rgb(0.0));
}

} // namespace
} // namespace keyhole
