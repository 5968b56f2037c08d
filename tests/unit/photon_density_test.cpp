#include "photonmap/density_estimate.h"

#include "core/statistics.h"
#include "photon_support.h"
#include "scene/warp.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using namespace photon_test;

const Vec3 kUp(0, 0, 1);

Rgb one(const Photon&) { return Rgb(1.0); }

DensityEstimate count_density(const PhotonMap& map, const PhotonQuery& q, Unbiased unbiased = Unbiased::density,
                              const SurfacePatches* patches = nullptr) {
    return estimate_density(map, q, unbiased, patches, one);
}

TEST(DensityEstimate, IsUnbiasedForTheDensityWithAndWithoutARadiusBound) {
    constexpr int n = 300, k = 6;
    // The second radius expects k photons, so that the bound cuts in half of the time.
    for (const double bound : {0.45, std::sqrt(k / (n * kPi))}) {
        RunningStats density;
        for (std::uint64_t i = 0; i < 5000; ++i) {
            Rng rng = make_rng(i);
            const PhotonMap map(throw_photons(kUnitSquare, n, rng));
            density.add(count_density(map, {{Vec3(0.5f, 0.5f, 0), kUp}, static_cast<float>(bound), k}).value.x);
        }
        expect_mean(density, n);
    }
}

TEST(DensityEstimate, IsUnbiasedForTheReciprocalDensity) {
    constexpr int n = 300, k = 6;
    RunningStats reciprocal, wrong;
    for (std::uint64_t i = 0; i < 5000; ++i) {
        Rng rng = make_rng(i);
        const PhotonMap map(throw_photons(kUnitSquare, n, rng));
        const PhotonQuery q{{Vec3(0.5f, 0.5f, 0), kUp}, 0.45f, k};
        reciprocal.add(1 / count_density(map, q, Unbiased::reciprocal).value.x);
        wrong.add(1 / count_density(map, q, Unbiased::density).value.x);
    }
    // A fixed number of photons, not a Poisson one: the k-th of n areas has the mean k / (n + 1).
    expect_mean(reciprocal, 1.0 / (n + 1));
    EXPECT_GT(wrong.mean(), 1.1 / n);
}

class DensityAtEdges : public testing::TestWithParam<Vec3> {};

TEST_P(DensityAtEdges, IsUnbiasedWhenTheAreaIsMeasured) {
    constexpr int n = 300, k = 12;
    std::vector<Shape> shapes;
    shapes.push_back(shape_of(kUnitSquare, 3));
    const SurfacePatches patches(shapes);
    RunningStats density, reciprocal;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        Rng rng = make_rng(i);
        const PhotonMap map(throw_photons(kUnitSquare, n, rng));
        const PhotonQuery q{{GetParam(), kUp}, 2, k};
        density.add(count_density(map, q, Unbiased::density, &patches).value.x);
        reciprocal.add(1 / count_density(map, q, Unbiased::reciprocal, &patches).value.x);
    }
    expect_mean(density, n);
    expect_mean(reciprocal, 1.0 / (n + 1));
}

INSTANTIATE_TEST_SUITE_P(UnitSquare, DensityAtEdges,
                         testing::Values(Vec3(0.5f, 0.5f, 0), Vec3(0, 0.4f, 0), Vec3(1, 1, 0), Vec3(0.98f, 0.05f, 0)));

TEST(DensityEstimate, IsAQuarterInACornerWhenTheDiscIsTaken) {
    constexpr int n = 300;
    RunningStats density;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        Rng rng = make_rng(i);
        const PhotonMap map(throw_photons(kUnitSquare, n, rng));
        density.add(count_density(map, {{Vec3(0), kUp}, 2, 12}).value.x);
    }
    expect_mean(density, n / 4.0);
}

TEST(DensityEstimate, IsUnbiasedOnASphere) {
    constexpr int n = 300;
    std::vector<Shape> shapes(1);
    shapes[0].geometry = Sphere{Vec3(1, 2, 3), 0.5f, false};
    const SurfacePatches patches(shapes);
    RunningStats density;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        Rng rng = make_rng(i);
        std::vector<Photon> photons;
        for (int j = 0; j < n; ++j) {
            const Vec3 out = uniform_sphere(rng.next(), rng.next());
            photons.emplace_back(Vec3(1, 2, 3) + out * 0.5f, out, out, Rgb(1.0));
        }
        const Vec3 out = Vec3(0.3f, -0.5f, 0.7f).normalized();
        density.add(count_density(PhotonMap(std::move(photons)), {{Vec3(1, 2, 3) + out * 0.5f, out}, 0.15f, 8},
                                  Unbiased::density, &patches)
                        .value.x);
    }
    expect_mean(density, n / (kPi * 4 * 0.25));
}

TEST(DensityEstimate, DoesNotLeakThroughASheet) {
    Rng rng = make_rng(0);
    std::vector<Photon> photons;
    throw_photons(kUnitSquare, 1000, rng, photons, Rgb(1, 0, 0), 1);
    throw_photons(kUnitSquare, 100'000, rng, photons, Rgb(0, 1, 0), -1);
    const PhotonMap map(std::move(photons));
    const DensityEstimate front = count_density(map, {{Vec3(0.5f, 0.5f, 0), kUp}, 0.5f, 200});
    const DensityEstimate back = count_density(map, {{Vec3(0.5f, 0.5f, 0), -kUp}, 0.5f, 200});
    EXPECT_EQ(front.value.y, 0);
    EXPECT_EQ(back.value.x, 0);
    EXPECT_EQ(front.photons, 199) << "the other side's photons counted against k";
    EXPECT_NEAR(front.value.x, 1000, 4 * 1000 / std::sqrt(198.0));
    EXPECT_NEAR(back.value.y, 100'000, 4 * 100'000 / std::sqrt(198.0));
}

TEST(DensityEstimate, DoesNotLeakInACornerNorFromASlab) {
    // A dim floor, a bright wall that meets it in the y axis, and a bright slab 3 mm above the floor's other half.
    const Rectangle wall{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, slab{{0.5f, 0, 0.003f}, {0.5f, 0, 0}, {0, 1, 0}};
    Rng rng = make_rng(0);
    std::vector<Photon> photons;
    throw_photons(kUnitSquare, 50'000, rng, photons, Rgb(1, 0, 0));
    throw_photons(wall, 50'000, rng, photons, Rgb(0, 1, 0));
    throw_photons(slab, 50'000, rng, photons, Rgb(0, 0, 1));
    const PhotonMap map(std::move(photons));
    for (const float x : {0.0f, 0.001f, 0.01f, 0.49f, 0.499f}) {
        const DensityEstimate e = count_density(map, {{Vec3(x, 0.5f, 0), kUp}, 0.02f, 40});
        EXPECT_GT(e.photons, 10);
        EXPECT_EQ(e.value.y, 0);
        EXPECT_EQ(e.value.z, 0);
    }
}

TEST(DensityEstimate, WeighsPhotonsByDirectionAndPower) {
    std::vector<Photon> photons;
    photons.emplace_back(Vec3(0), kUp, Vec3(0.6f, 0, 0.8f), Rgb(1, 2, 3));
    photons.emplace_back(Vec3(0.1f, 0, 0), kUp, Vec3(0, 0, 1), Rgb(4, 4, 4));
    const PhotonMap map(std::move(photons));
    const auto weight = [](const Photon& p) { return Rgb(p.direction().z); };
    const auto e = estimate_density(map, {{Vec3(0), kUp}, 0.5f, 10}, Unbiased::density, nullptr, weight);
    EXPECT_EQ(e.photons, 2);
    EXPECT_NEAR(e.area, kPi * 0.25, 1e-6);
    EXPECT_NEAR(e.value.y, (0.8 * 2 + 4) / (kPi * 0.25), 1e-3);
}

} // namespace
} // namespace keyhole
