// Estimates from photons that come in clumps, as those of a chain do.
#include "photon_support.h"
#include "photonmap/irradiance/irradiance_map.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using namespace photon_test;

constexpr int kClumps = 60, kInClump = 8, kMean = kClumps * kInClump;
const PhotonQuery kMiddle{{Vec3(0.5f, 0.5f, 0), Vec3(0, 0, 1)}, 0.45f, 24};

double one(const Photon&) { return 1; }

/// Photons in clumps of a hundredth of the square's side, which wrap around at its borders: mean density kMean.
std::vector<Photon> clumped(int clumps, Rng& rng) {
    std::vector<Photon> photons;
    for (int c = 0; c < clumps; ++c) {
        const double x = rng.next(), y = rng.next();
        for (int i = 0; i < kInClump; ++i)
            photons.emplace_back(
                kUnitSquare.at(std::fmod(x + 0.01 * rng.next(), 1), std::fmod(y + 0.01 * rng.next(), 1)),
                kUnitSquare.normal(), kUnitSquare.normal(), Rgb(1.0));
    }
    return photons;
}

PhotonSet clumped_set(Rng& rng) {
    PhotonSet set;
    set.pilots = clumped(kClumps / (kPilotEvery - 1), rng);
    set.main_photons = clumped(kClumps, rng);
    return set;
}

TEST(PilotedMap, HasTheRightExpectationForClumpedPhotons) {
    RunningStats piloted, shrunk, nearest;
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        Rng rng = make_rng(i);
        const PilotedMap map(clumped_set(rng));
        PhotonQuery query = kMiddle;
        piloted.add(estimate_density(map, query, nullptr, one).value.x);
        nearest.add(estimate_density(map.main_photons(), query, Unbiased::density, nullptr, one).value.x);
        query.shrink = 0.5f;
        shrunk.add(estimate_density(map, query, nullptr, one).value.x);
    }
    expect_mean(piloted, kMean);
    expect_mean(shrunk, kMean);
    EXPECT_GT(nearest.mean(), 1.1 * kMean) << "clumps don't show, so the test shows nothing";
}

TEST(PilotedMap, IsNotPulledUpWhereEstimatesAreMadeAtPhotons) {
    RunningStats at_pilots;
    for (std::uint64_t i = 0; i < 6000; ++i) {
        Rng rng = make_rng(i);
        const PhotonSet set = clumped_set(rng);
        const PhotonMap pilots(set.pilots), main_photons(set.main_photons);
        const IrradianceMap map(pilots, main_photons, {.k = kMiddle.k, .max_radius = kMiddle.max_radius}, {});
        at_pilots.add(map.irradiance(kMiddle.region.position, kMiddle.region.normal).irradiance.x);
    }
    expect_mean(at_pilots, kMean);
}

TEST(PilotedMap, AnswersWithoutPilotsOverTheLargestRegion) {
    Rng rng = make_rng(1);
    PhotonSet set;
    set.main_photons = throw_photons(kUnitSquare, 20'000, rng);
    const DensityEstimate e = estimate_density(PilotedMap(std::move(set)), kMiddle, nullptr, one);
    EXPECT_EQ(e.radius, kMiddle.max_radius);
    EXPECT_NEAR(e.value.x, 20'000, 4 * std::sqrt(20'000));
}

} // namespace
} // namespace keyhole
