// What two short renders tell of the error of a method.
#include "methods/choice/trial_error.h"

#include "core/rng.h"
#include "methods/choice/method_trials.h"
#include "methods/method.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

constexpr int kWidth = 64, kHeight = 48;

double normal(Rng& rng) { return std::sqrt(-2 * std::log(1 - rng.next())) * std::cos(6.283185307 * rng.next()); }

/// A picture of a gradient, with grain of relative standard deviation `grain` in each pixel and `blotches` in each
/// block of 4x4; the upper half is darker by the factor `found`.
Image noisy(double grain, double blotches, double found, std::uint64_t seed) {
    Rng rng(seed, StreamPurpose::test, 0);
    std::vector<double> of_block(static_cast<std::size_t>(kWidth / 4 * kHeight / 4));
    for (double& b : of_block) b = 1 + blotches * normal(rng);
    Image image(kWidth, kHeight, 1);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double truth = (1 + x / 64.0) * (y < kHeight / 2 ? found : 1.0);
            const double block = of_block[static_cast<std::size_t>(y / 4 * (kWidth / 4) + x / 4)];
            *image.at(x, y) = static_cast<float>(truth * (block + grain * normal(rng)));
        }
    return image;
}

TrialPictures halves(double grain, double blotches, double found, std::uint64_t seed) {
    return {noisy(grain, blotches, found, 2 * seed), noisy(grain, blotches, found, 2 * seed + 1)};
}

TEST(TrialErrors, TellGrainFromBlotches) {
    const std::vector<TrialPictures> methods{halves(0.3, 0, 1, 1), halves(0.05, 0.2, 1, 2)};
    const std::vector<TrialError> e = trial_errors(methods);
    EXPECT_NEAR(e[0].grain, 0.09, 0.015);
    EXPECT_LT(e[0].blotches, 0.01);
    EXPECT_NEAR(e[1].blotches, 0.04, 0.012);
    EXPECT_NEAR(e[1].grain, 0.0025, 0.003);
    EXPECT_EQ(e[0].missing, 0);
    EXPECT_EQ(e[1].missing, 0);
}

TEST(TrialErrors, MissLightThatTwoRendersAgreeNotToFind) {
    const std::vector<TrialPictures> methods{halves(0.3, 0, 1, 3), halves(0.02, 0, 0.3, 4)};
    const std::vector<TrialError> e = trial_errors(methods);
    EXPECT_EQ(e[0].missing, 0);
    EXPECT_GT(e[1].missing, 0.1) << "half of the picture lacks two thirds of its light";
}

/// Two renders that err alike in each of the large parts of a picture, by a relative standard deviation of 0.05.
TrialPictures wrong_by_parts(std::uint64_t seed) {
    TrialPictures m = halves(0, 0, 1, seed);
    Rng rng(seed, StreamPurpose::test, 1);
    for (Image* image : {&m.first, &m.second})
        for (int part = 0; part < kTrialParts; ++part) {
            const auto brighter = static_cast<float>(1 + 0.05 * normal(rng));
            for (int y = 0; y < kHeight / 4; ++y)
                for (int x = 0; x < kWidth / 4; ++x)
                    *image->at(part % 4 * kWidth / 4 + x, part / 4 * kHeight / 4 + y) *= brighter;
        }
    return m;
}

/// Of the first of two methods, the mean over many trials.
double mean_missing(double found) {
    constexpr int kTrials = 100;
    double missing = 0;
    for (std::uint64_t seed = 0; seed < kTrials; ++seed) {
        const std::vector<TrialPictures> methods{halves(0.1, 0, found, seed), wrong_by_parts(seed)};
        missing += trial_errors(methods)[0].missing;
    }
    return missing / kTrials;
}

/// Chains err alike in large parts of a picture, and two renders agree in one of them by chance: that the part is
/// brighter there tells nothing of what others miss. What is missing shows all the same.
TEST(TrialErrors, MissNothingWhereOneMethodAgreesWithItselfByChance) {
    EXPECT_LT(mean_missing(1), 5e-7);
    EXPECT_GT(mean_missing(0.7), 0.01) << "half of the picture lacks three tenths of its light";
}

/// Both renders of the one are black but for a few samples, and so agree: errors are not relative to that.
TEST(TrialErrors, AreNotRelativeToThePictureOfAMethodThatFindsNothing) {
    std::vector<TrialPictures> methods{halves(0.1, 0, 1, 1), halves(0, 0, 0, 2)};
    for (Image* image : {&methods[1].first, &methods[1].second}) std::ranges::fill(image->data, 0.0f);
    *methods[1].first.at(5, 5) = 100;
    const std::vector<TrialError> e = trial_errors(methods);
    EXPECT_NEAR(e[0].grain, 0.01, 0.002);
    EXPECT_GT(e[1].missing, 0.5);
}

/// One sample in hundreds brings all the light: its mean is right in each part, and the picture is dark with dots.
TEST(TrialErrors, MissLightThatComesInDots) {
    std::vector<TrialPictures> methods{halves(0.1, 0, 1, 1), halves(0, 0, 1, 2)};
    constexpr int kAcross = kWidth / 4, kDown = kHeight / 4;
    int more = 0;
    for (Image* image : {&methods[1].first, &methods[1].second}) {
        for (float& v : image->data) v *= 0.15f;
        for (int part = 0; part < kTrialParts; ++part, more += 3)
            *image->at(part % 4 * kAcross + more % kAcross, part / 4 * kDown + more % kDown) = 1.3f * kAcross * kDown;
    }
    EXPECT_GT(trial_errors(methods)[1].missing, 0.5);
}

/// A table in bright light and a mirror beside it, a tenth as bright, of which two thirds of the light come in samples
/// of which `every`-th pixel has one. No part of the picture is darker in the mean than another method finds it.
TrialPictures mirror_with_dots(int every, std::uint64_t seed) {
    TrialPictures m = halves(0.3, 0, 1, seed);
    m.rare_samples = true;
    Rng rng(seed, StreamPurpose::test, 2);
    for (Image* image : {&m.first, &m.second})
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                float& v = *image->at(x, y);
                if (x % 16 >= 8) continue;
                v *= 0.1f;
                if (every > 0) v *= rng.next() * every < 1 ? 1.0f / 3 + static_cast<float>(every) * 2 / 3 : 1.0f / 3;
            }
    return m;
}

TEST(TrialErrors, CountLightThatOnlyDotsBring) {
    const std::vector<TrialPictures> methods{mirror_with_dots(0, 1), mirror_with_dots(500, 2), mirror_with_dots(4, 3)};
    const std::vector<TrialError> e = trial_errors(methods);
    EXPECT_EQ(e[1].missing, 0) << "by its means";
    EXPECT_GT(e[1].dots, 0.1) << "half of the picture lacks two thirds of its light, but in some pixels";
    EXPECT_LT(e[1].dots, 0.5);
    EXPECT_LT(e[0].dots, 0.005);
    EXPECT_LT(e[2].dots, 0.02) << "each block of pixels has some: that is grain";
}

/// Chains stay where their seeds were: of two renders each is dark in most places, but not in the same ones.
TEST(TrialErrors, CountLightThatChainsFindInAFewPlaces) {
    std::vector<TrialPictures> methods{halves(0.3, 0, 1, 1), halves(0.1, 0, 1, 2)};
    methods[0].by_photons = true;
    Rng rng(3, StreamPurpose::test, 2);
    for (Image* image : {&methods[1].first, &methods[1].second})
        for (int y = 0; y < kHeight; y += 4)
            for (int x = 0; x < kWidth; x += 4) {
                const float there = rng.next() < 0.2 ? 5.0f : 0.0f;
                for (int i = 0; i < 16; ++i) *image->at(x + i % 4, y + i / 4) *= there;
            }
    const std::vector<TrialError> e = trial_errors(methods);
    EXPECT_GT(e[1].dots, 0.5);
    EXPECT_EQ(e[0].dots, 0);
}

TEST(TrialErrors, WarnOfLightThatOnlyDotsBring) {
    RenderStats stats;
    warn_of_dots(methods::bdpt, {.grain = 1, .missing = 1, .dots = 0.001}, stats);
    EXPECT_TRUE(stats.warnings.empty());
    warn_of_dots(methods::bdpt, {.dots = 0.1}, stats);
    ASSERT_EQ(stats.warnings.size(), 1u);
    EXPECT_NE(stats.warnings[0].find("bdpt brings in a few bright samples"), std::string::npos);
}

TEST(TrialErrors, OfNarrowerPixelsAreLessOnlyBeyondChance) {
    EXPECT_EQ(variance_less(halves(1, 0, 1, 1), halves(0.99, 0, 1, 2)), 0);
    EXPECT_NEAR(variance_less(halves(0.3, 0, 1, 1), halves(0.1, 0, 1, 2)), 0.06, 0.02);
}

/// Columns 8 pixels wide of shadow, which have the factor `dark`, and of light, which have `lit`.
TrialPictures shadowed(TrialPictures m, double dark, double lit) {
    for (Image* image : {&m.first, &m.second})
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) *image->at(x, y) *= static_cast<float>(x % 16 < 8 ? dark : lit);
    return m;
}

TEST(TrialErrors, TellWhatPhotonsBlur) {
    const TrialPictures samples = shadowed(halves(0.4, 0, 1, 1), 0.4, 1.6), photons = halves(0.05, 0.05, 1, 2);
    // Relative to the mean of both.
    const double truth = (0.6 * 0.6 / (0.7 * 0.7) + 0.6 * 0.6 / (1.3 * 1.3)) / 2;
    EXPECT_GT(blur(shadowed(photons, 1, 1), samples), 0.7 * truth);
    EXPECT_LT(blur(shadowed(photons, 1, 1), samples), 1.3 * truth);
    const double half = blur(shadowed(photons, 0.7, 1.3), samples);
    EXPECT_GT(half, 0.1 * truth);
    EXPECT_LT(half, 0.4 * truth);
    EXPECT_LT(blur(shadowed(photons, 0.4, 1.6), samples), 0.002) << "the same light, and noise";
}

TEST(TrialErrors, DontBlamePhotonsForLightThatSamplesMiss) {
    const TrialPictures photons = halves(0.05, 0.05, 1, 2);
    EXPECT_EQ(blur(photons, halves(0.4, 0, 0.6, 1)), 0) << "half of the picture lacks .4";
    EXPECT_EQ(blur(photons, shadowed(halves(0.4, 0, 1, 1), 0.4, 1)), 0) << "columns do";
    EXPECT_EQ(blur(photons, {Image(kWidth, kHeight, 1), Image(kWidth, kHeight, 1)}), 0);
}

/// One pixel in 200 has met light that is rare: in a picture of ten times the samples one in 20 will.
TEST(TrialErrors, CountBrightSamplesThatAreRare) {
    std::vector<TrialPictures> methods{halves(0.05, 0, 1, 1), halves(0.05, 0, 1, 2)};
    Rng rng(3, StreamPurpose::test, 0);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            if (rng.next() < 0.005) *methods[0].first.at(x, y) *= 10;
    EXPECT_LT(trial_errors(methods)[0].grain, 0.03) << "of photons, these are few places";
    methods[0].rare_samples = true;
    const std::vector<TrialError> e = trial_errors(methods);
    // Relative to the mean with both methods: (9 / 1)^2 / 2 of half a percent, less what is left out.
    EXPECT_GT(e[0].grain, 0.03);
    EXPECT_LT(e[1].grain, 0.01);
}

TEST(TrialErrors, AreNoSmallerForALampInView) {
    std::vector<TrialPictures> methods{halves(0.3, 0, 1, 1), halves(0.05, 0.2, 1, 2), halves(0.02, 0, 0.3, 4)};
    const std::vector<TrialError> without = trial_errors(methods);
    for (TrialPictures& m : methods) *m.first.at(5, 5) = *m.second.at(5, 5) = 1e5f;
    const std::vector<TrialError> with = trial_errors(methods);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        // A few pixels around it are compared with the lamp.
        EXPECT_NEAR(with[i].grain, without[i].grain, 0.1 * without[i].grain + 1e-3);
        EXPECT_NEAR(with[i].blotches, without[i].blotches, 0.1 * without[i].blotches + 1e-3);
        EXPECT_NEAR(with[i].missing, without[i].missing, 0.2 * without[i].missing + 1e-3);
    }
}

TEST(TrialErrors, OfBlackPicturesAreThatEverythingIsMissing) {
    const std::vector<TrialPictures> methods{{Image(kWidth, kHeight, 1), Image(kWidth, kHeight, 1)},
                                             halves(0.1, 0, 1, 5)};
    const std::vector<TrialError> e = trial_errors(methods);
    EXPECT_GT(e[0].missing, 0.5);
    EXPECT_TRUE(std::isfinite(e[0].grain + e[0].blotches));
    EXPECT_EQ(e[1].missing, 0);
    // Nor does it help that nobody else is sure.
    const std::vector<TrialPictures> unsure{methods[0], halves(0, 4, 1, 6)};
    EXPECT_GT(trial_errors(unsure)[0].missing, 0.5);
    EXPECT_EQ(trial_errors(unsure)[1].missing, 0);
    const std::vector<TrialError> alone = trial_errors(std::span(methods).first(1));
    EXPECT_EQ(alone[0].grain + alone[0].blotches + alone[0].missing, 0);
}

/// Two renders with light in `lit` pixels of the first rows, in each of them with probability `found` and brighter by
/// its reciprocal.
TrialPictures in_a_few_pixels(int lit, double found, std::uint64_t seed) {
    const auto render = [&](std::uint64_t of) {
        Rng rng(of, StreamPurpose::test, 0);
        Image image(kWidth, kHeight, 1);
        for (int i = 0; i < lit; ++i)
            if (rng.next() < found) image.data[static_cast<std::size_t>(i)] = static_cast<float>(1 / found);
        return image;
    };
    return {render(2 * seed), render(2 * seed + 1), true};
}

TEST(TrialErrors, AreNotNoneWhereTrialsFindLittleLight) {
    // The light of 1 % of the pixels would be left out as that of lamps, and all its errors as the largest.
    const std::vector<TrialPictures> methods{in_a_few_pixels(30, 0.1, 1), in_a_few_pixels(30, 0.9, 2)};
    const std::vector<TrialError> e = trial_errors(methods);
    const auto all = [](const TrialError& of) { return of.grain + of.blotches; };
    EXPECT_GT(all(e[0]), 4 * all(e[1])) << "9 for 1/9 by their variances";
    EXPECT_GT(all(e[1]), 0);
    // A black picture has all errors.
    const std::vector<TrialPictures> none{in_a_few_pixels(30, 0, 3), methods[0]};
    const std::vector<TrialError> of_none = trial_errors(none);
    EXPECT_GT(of_none[0].missing, 4 * of_none[1].missing);
    EXPECT_NEAR(share_lit(methods), 30.0 / (kWidth * kHeight), 1e-3);
    EXPECT_EQ(share_lit(std::span(none).first(1)), 0);
}

} // namespace
} // namespace keyhole
