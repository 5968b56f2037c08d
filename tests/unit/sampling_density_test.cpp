// Adaptive sampling: where samples go, and that where they go says nothing about what they bring.
#include "session/sampling_density.h"

#include "core/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace keyhole {
namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

/// Decides by a pilot of samples sample(x, y, numbers).
SamplingDensity density_of(int rounds, std::uint64_t seed,
                           const std::function<double(int, int, SampleSource&)>& sample) {
    SamplingDensity density(kWidth, kHeight);
    for (std::size_t p = 0; p < kPixels; ++p) {
        Rng rng(seed, StreamPurpose::test, p);
        for (int round = 0; round < rounds; ++round)
            density.add(p, sample(static_cast<int>(p % kWidth), static_cast<int>(p / kWidth), rng), half_of(round));
    }
    density.decide();
    return density;
}

double mean_of(const SamplingDensity& density) {
    double sum = 0;
    for (std::size_t p = 0; p < kPixels; ++p) sum += density.at(p);
    return sum / kPixels;
}

/// Left of the middle samples are noisier.
double uneven(int x, int /*y*/, SampleSource& rng) { return 1 + (x < kWidth / 2 ? 0.6 : 0.2) * (rng.next() - 0.5); }

TEST(SamplingDensity, GoesAsTheRootOfTheVariance) {
    const SamplingDensity density = density_of(16, 1, uneven);
    EXPECT_NEAR(mean_of(density), 1, 1e-4);
    double left = 0, right = 0;
    for (int y = 0; y < kHeight; ++y) {
        left += density.at(static_cast<std::size_t>(y * kWidth + kWidth / 4)) / kHeight;
        right += density.at(static_cast<std::size_t>(y * kWidth + 3 * kWidth / 4)) / kHeight;
    }
    EXPECT_NEAR(left / right, 3, 0.3); // 1.5 and 0.5
    // Of even samples: (9 + 1) / 2; of these: (9 / 1.5 + 1 / 0.5) / 2.
    EXPECT_NEAR(density.error_over_even(), 0.8, 0.05);
}

TEST(SamplingDensity, IsRelativeToLight) {
    const SamplingDensity density = density_of(16, 2, [](int x, int, SampleSource& rng) {
        return (x < kWidth / 2 ? 10 : 1) * (1 + 0.2 * (rng.next() - 0.5));
    });
    // All but the pixels along the edge are equally noisy beside their light.
    for (std::size_t p = 0; p < kPixels; ++p) {
        const bool at_edge = std::abs(static_cast<int>(p % kWidth) - kWidth / 2) <= 9;
        EXPECT_TRUE(at_edge || std::abs(density.at(p) - 1) < 0.35) << p << ": " << density.at(p);
    }
}

TEST(SamplingDensity, IsEvenWhereTheHalvesOfThePilotDontAgree) {
    // One sample in five hundred is bright, wherever: where the pilot met one says nothing about where others will be.
    const SamplingDensity density =
        density_of(8, 3, [](int, int, SampleSource& rng) { return rng.next() < 0.002 ? 100.0 : 1.0; });
    for (std::size_t p = 0; p < kPixels; ++p) EXPECT_NEAR(density.at(p), 1, 0.3) << p;
}

TEST(SamplingDensity, OfAPictureWithoutNoiseOrLightIsEven) {
    for (const double value : {0.0, 2.0}) {
        const SamplingDensity density = density_of(8, 4, [&](int, int, SampleSource&) { return value; });
        for (std::size_t p = 0; p < kPixels; ++p) ASSERT_EQ(density.at(p), 1) << value;
        EXPECT_EQ(density.error_over_even(), 1);
    }
}

TEST(SamplingDensity, OfASinglePixelIsEven) {
    SamplingDensity density(1, 1);
    for (int i = 0; i < 8; ++i) density.add(0, i, half_of(i));
    density.decide();
    EXPECT_EQ(density.at(0), 1);
}

TEST(SamplingDensity, AsksAllPixelsButItsOwn) {
    const std::size_t pixel = 12 * kWidth + 30, next = pixel + 1;
    const auto with = [&](double factor) {
        return density_of(16, 5, [&](int x, int y, SampleSource& rng) {
            const double value = uneven(x, y, rng);
            return static_cast<std::size_t>(y * kWidth + x) == pixel ? 1 + factor * (value - 1) : value;
        });
    };
    const SamplingDensity usual = with(1), noisy = with(6);
    // What the neighbours get more of is missing everywhere else, by their share of the picture.
    EXPECT_NEAR(noisy.at(pixel) / usual.at(pixel), 1, 0.02);
    EXPECT_GT(noisy.at(next) / usual.at(next), 1.5);
}

TEST(SamplingDensity, SharesOutSamplesEvenlyOverRounds) {
    const SamplingDensity density = density_of(16, 6, uneven);
    for (const std::size_t pixel : {std::size_t{205}, std::size_t{235}}) {
        double mean = 0;
        constexpr int kShifts = 1000;
        for (int i = 0; i < kShifts; ++i) {
            const double shift = (i + 0.5) / kShifts;
            EXPECT_EQ(density.samples_before(pixel, 0, shift), 0);
            const auto samples = static_cast<double>(density.samples_before(pixel, 7, shift));
            EXPECT_NEAR(samples, 7 * density.at(pixel), 1);
            mean += samples / kShifts;
        }
        EXPECT_NEAR(mean, 7 * density.at(pixel), 0.002);
    }
}

} // namespace
} // namespace keyhole
