// The reconstruction filter: what it samples is what it says.
#include "core/rng.h"
#include "film/filter.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

using namespace keyhole;

namespace {

constexpr int kBins = 16;

PixelFilter make(FilterShape kind, double radius = 0, double sigma = 0) {
    Settings settings;
    settings.filter = kind;
    settings.filter_radius = radius;
    settings.filter_sigma = sigma;
    return PixelFilter(settings);
}

/// Integral of the density over one of kBins x kBins bins of the support by the midpoint rule.
double bin_mass(const PixelFilter& filter, int bx, int by) {
    constexpr int kSteps = 20;
    const double h = 2 * filter.radius() / (kBins * kSteps);
    double sum = 0;
    for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < kSteps; ++i)
            sum += filter.density({static_cast<float>(-filter.radius() + h * (bx * kSteps + i + 0.5)),
                                   static_cast<float>(-filter.radius() + h * (by * kSteps + j + 0.5))});
    return sum * h * h;
}

class EveryFilter : public testing::TestWithParam<int> {
  protected:
    PixelFilter
        filter = std::array{make(FilterShape::gaussian), make(FilterShape::gaussian, 1.5, 0.5),
                            make(FilterShape::box),      make(FilterShape::box, 2),
                            make(FilterShape::triangle), make(FilterShape::triangle, 2.5)}[static_cast<std::size_t>(
            GetParam())];
};

} // namespace

TEST_P(EveryFilter, SamplesFollowTheDensity) {
    constexpr int kSamples = 400'000;
    Rng rng(1, StreamPurpose::test, 7);
    std::array<double, kBins * kBins> seen{};
    const double r = filter.radius();
    for (int s = 0; s < kSamples; ++s) {
        const double u0 = rng.next(), u1 = rng.next();
        const Vec2 o = filter.sample_offset(u0, u1);
        ASSERT_LE(static_cast<double>(std::max(std::abs(o.x), std::abs(o.y))), r);
        const int bx = std::min(kBins - 1, static_cast<int>((o.x + r) / (2 * r) * kBins));
        const int by = std::min(kBins - 1, static_cast<int>((o.y + r) / (2 * r) * kBins));
        ++seen[static_cast<std::size_t>(by * kBins + bx)];
    }
    double chi2 = 0, degrees = -1, rare_seen = 0, rare_expected = 0;
    for (int b = 0; b < kBins * kBins; ++b) {
        const double expected = kSamples * bin_mass(filter, b % kBins, b / kBins);
        const double found = seen[static_cast<std::size_t>(b)];
        if (expected < 10) {
            rare_seen += found;
            rare_expected += expected;
            continue;
        }
        chi2 += std::pow(found - expected, 2) / expected;
        ++degrees;
    }
    if (rare_expected > 0) chi2 += std::pow(rare_seen - rare_expected, 2) / rare_expected;
    // Either tail would be a mistake.
    EXPECT_LT(chi2, degrees + 4.5 * std::sqrt(2 * degrees));
    EXPECT_GT(chi2, degrees - 4.5 * std::sqrt(2 * degrees));
}

TEST_P(EveryFilter, DensityIntegratesToOneAndVanishesOutside) {
    double sum = 0;
    for (int by = 0; by < kBins; ++by)
        for (int bx = 0; bx < kBins; ++bx) sum += bin_mass(filter, bx, by);
    EXPECT_NEAR(sum, 1.0, 1e-4);
    const auto outside = static_cast<float>(filter.radius() * 1.01);
    EXPECT_EQ(filter.density({outside, 0}), 0);
    EXPECT_EQ(filter.density({0, -outside}), 0);
}

/// The distribution function of the offset along x is u.
TEST_P(EveryFilter, OffsetInvertsTheDistributionFunction) {
    for (const double u : {0.001, 0.1, 0.4, 0.6, 0.95, 0.9999}) {
        const double x = filter.sample_offset(u, 0.5).x, along_y = filter.density({0, 0});
        constexpr int kSteps = 100'000;
        const double h = (x + filter.radius()) / kSteps;
        double mass = 0;
        for (int i = 0; i < kSteps; ++i)
            mass += h * filter.density({static_cast<float>(-filter.radius() + h * (i + 0.5)), 0});
        EXPECT_NEAR(mass / std::sqrt(along_y), u, 2e-5);
        EXPECT_NEAR(filter.sample_offset(0.5, 1 - u).y, -x, 1e-6);
    }
    EXPECT_FLOAT_EQ(filter.sample_offset(0, 0).x, static_cast<float>(-filter.radius()));
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryFilter, testing::Range(0, 6));

TEST(PixelFilter, HasTheShapeOfItsKind) {
    EXPECT_NEAR(make(FilterShape::gaussian).density({0.5f, 0}) / make(FilterShape::gaussian).density({0, 0}),
                std::exp(-0.125), 1e-6);
    EXPECT_NEAR(make(FilterShape::gaussian).density({1, 1}) / make(FilterShape::gaussian).density({0, 0}),
                std::exp(-1.0), 1e-6);
    EXPECT_NEAR(make(FilterShape::gaussian, 1.5, 0.5).density({1, 0}) /
                    make(FilterShape::gaussian, 1.5, 0.5).density({0, 0}),
                std::exp(-2.0), 1e-6);
    EXPECT_NEAR(make(FilterShape::triangle, 2).density({1, 0}) / make(FilterShape::triangle, 2).density({0, 0}), 0.5,
                1e-6);
    EXPECT_NEAR(make(FilterShape::box).density({0.4f, -0.3f}), 1, 1e-6);
}

/// Also in the tail of one that is narrow beside its radius, where the distribution function is all but flat.
TEST(PixelFilter, DrawsWhatItsDistributionSays) {
    for (const auto& [radius, sigma] : {std::pair{1.0, 1.0}, {2.0, 0.5}, {2.0, 0.1}}) {
        const PixelFilter filter = make(FilterShape::gaussian, radius, sigma);
        for (const double u : {0.5001, 0.7, 0.99, 0.999, 0.9999, 0.999999}) {
            const double x = filter.sample_offset(u, 0.5).x, root2 = std::numbers::sqrt2;
            EXPECT_NEAR(std::erf(x / sigma / root2) / std::erf(radius / sigma / root2), 2 * u - 1, 1e-7)
                << "radius " << radius << ", sigma " << sigma << ", u " << u;
        }
    }
}

/// A splat's weights over all pixels average to 1 over the film: splatting neither makes nor loses light.
TEST(PixelFilter, SplatsKeepEnergy) {
    const PixelFilter filter;
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
