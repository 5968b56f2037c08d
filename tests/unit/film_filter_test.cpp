// The reconstruction filter: what it samples is what it says.
#include "core/rng.h"
#include "film/filter.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace keyhole;

namespace {

constexpr int kBins = 16;

/// Integral of the density over a bin of [-1,1]^2 by the midpoint rule.
double bin_mass(const GaussianFilter& filter, int bx, int by) {
    constexpr int kSteps = 20;
    constexpr double h = 2.0 / (kBins * kSteps);
    double sum = 0;
    for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < kSteps; ++i)
            sum += filter.density({static_cast<float>(-1 + h * (bx * kSteps + i + 0.5)),
                                   static_cast<float>(-1 + h * (by * kSteps + j + 0.5))});
    return sum * h * h;
}

} // namespace

TEST(GaussianFilter, SamplesFollowTheDensity) {
    constexpr int kSamples = 400'000;
    const GaussianFilter filter;
    Rng rng(1, StreamPurpose::test, 7);
    std::array<double, kBins * kBins> seen{};
    for (int s = 0; s < kSamples; ++s) {
        const double u0 = rng.next(), u1 = rng.next();
        const Vec2 o = filter.sample_offset(u0, u1);
        ASSERT_LE(std::max(std::abs(o.x), std::abs(o.y)), GaussianFilter::kRadius);
        const int bx = std::min(kBins - 1, static_cast<int>((o.x + 1) / 2 * kBins));
        const int by = std::min(kBins - 1, static_cast<int>((o.y + 1) / 2 * kBins));
        ++seen[static_cast<std::size_t>(by * kBins + bx)];
    }
    double chi2 = 0;
    for (int b = 0; b < kBins * kBins; ++b) {
        const double expected = kSamples * bin_mass(filter, b % kBins, b / kBins);
        chi2 += std::pow(seen[static_cast<std::size_t>(b)] - expected, 2) / expected;
    }
    // 255 degrees of freedom: mean 255, standard deviation 22.6. Either tail would be a mistake.
    EXPECT_LT(chi2, 255 + 4.5 * 22.6);
    EXPECT_GT(chi2, 255 - 4.5 * 22.6);
}

TEST(GaussianFilter, DensityIntegratesToOneAndVanishesOutside) {
    const GaussianFilter filter;
    double sum = 0;
    for (int by = 0; by < kBins; ++by)
        for (int bx = 0; bx < kBins; ++bx) sum += bin_mass(filter, bx, by);
    EXPECT_NEAR(sum, 1.0, 1e-4);
    EXPECT_EQ(filter.density({1.01f, 0}), 0);
    EXPECT_EQ(filter.density({0, -1.01f}), 0);
}

TEST(GaussianFilter, HasTheShapeOfSigmaOne) {
    const GaussianFilter filter;
    EXPECT_NEAR(filter.density({0.5f, 0}) / filter.density({0, 0}), std::exp(-0.125), 1e-6);
    EXPECT_NEAR(filter.density({1, 1}) / filter.density({0, 0}), std::exp(-1.0), 1e-6);
}

TEST(GaussianFilter, OffsetInvertsTheDistributionFunction) {
    const GaussianFilter filter;
    const double mass = std::erf(std::sqrt(0.5));
    for (const double x : {0.0, 1e-6, 0.1, 0.5, 0.9, 0.999}) {
        const double u = 0.5 * (1 + std::erf(x * std::sqrt(0.5)) / mass);
        EXPECT_NEAR(filter.sample_offset(u, 1 - u).x, x, 1e-6);
        EXPECT_NEAR(filter.sample_offset(u, 1 - u).y, -x, 1e-6);
    }
    EXPECT_FLOAT_EQ(filter.sample_offset(0, 0).x, -1);
}

/// A splat's weights over all pixels average to 1 over the film: splatting neither makes nor loses light.
TEST(GaussianFilter, SplatsKeepEnergy) {
    const GaussianFilter filter;
    constexpr int kSteps = 200;
    double sum = 0;
    for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < kSteps; ++i)
            for (int py = -1; py <= 1; ++py)
                for (int px = -1; px <= 1; ++px)
                    sum += filter.density({static_cast<float>((i + 0.5) / kSteps - 0.5 - px),
                                           static_cast<float>((j + 0.5) / kSteps - 0.5 - py)});
    EXPECT_NEAR(sum / (kSteps * kSteps), 1.0, 1e-3);
}
