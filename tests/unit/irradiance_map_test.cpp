// Irradiance made of photons beforehand.
#include "photonmap/irradiance/irradiance_map.h"

#include "core/statistics.h"
#include "photon_support.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

using namespace photon_test;

constexpr float kReach = 0.1f; // of estimates [m]

/// Mean of the estimates made between `from` and `to` along x, over the irradiance there, of photons on a floor whose
/// density is density(x) [1/m^2], up to a factor.
template <class Density> double over_truth(const Density& density, int photons, float from, float to) {
    const Rectangle floor{{0, 0, 0}, {0, 0, 1}, {0.5f, 0, 0}};
    const std::vector<Shape> shapes = [&] {
        std::vector<Shape> list;
        list.push_back(shape_of(floor));
        return list;
    }();
    Rng rng = make_rng(5);
    std::vector<Photon> main_photons, pilots;
    double mean = 0;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i) mean += density(0.5 * (i + 0.5) / kSteps) / kSteps;
    while (static_cast<int>(main_photons.size()) < photons) {
        const auto x = static_cast<float>(0.5 * rng.next()), z = static_cast<float>(rng.next());
        if (rng.next() < density(x)) main_photons.emplace_back(Vec3(x, 0, z), Vec3(0, 1, 0), Vec3(0, 1, 0), Rgb(1.0));
    }
    for (int i = 0; i < 40; ++i) // so few that estimates look as far as they may
        pilots.emplace_back(
            Vec3(from + (to - from) * static_cast<float>(rng.next()), 0, static_cast<float>(0.2 + 0.6 * rng.next())),
            Vec3(0, 1, 0), Vec3(0, 1, 0), Rgb(1.0));
    const PhotonMap main_map(std::move(main_photons)), pilot_map(std::move(pilots), PhotonMap::Wanted::one);
    const SurfacePatches patches(shapes);
    const IrradianceMap map(pilot_map, main_map, {.k = 1000, .max_radius = kReach, .patches = &patches}, {});
    double found = 0, truth = 0;
    for (const Photon& p : map.places()) {
        found += map.irradiance(p.position(), Vec3(0, 1, 0)).irradiance.x;
        truth += photons / 0.5 * density(p.position().x) / mean;
    }
    return found / truth;
}

TEST(IrradianceMap, IsTheMeanOfItsPhotonsWhereLightIsEvenOrFallsEvenly) {
    const auto even = [](double) { return 1.0; };
    EXPECT_NEAR(over_truth(even, 100'000, 0.2f, 0.3f), 1, 0.03);
    EXPECT_NEAR(over_truth(even, 1000, 0.2f, 0.3f), 1, 0.1);
    const auto slope = [](double x) { return 1 - x; };
    EXPECT_NEAR(over_truth(slope, 100'000, 0.2f, 0.3f), 1, 0.03);
}

} // namespace
} // namespace keyhole
