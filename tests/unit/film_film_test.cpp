// The film: means, dropped samples, empty pixels.
#include "film/film.h"

#include "core/rng.h"
#include "core/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

using namespace keyhole;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

std::vector<float> pixel(const Picture& picture, const std::string& layer, int x, int y) {
    const Image& image = picture.layers.at(layer);
    return {image.at(x, y), image.at(x, y) + image.channels};
}

PixelSample full_sample() {
    PixelSample s;
    s.direct = Rgb(1, 2, 3);
    s.indirect = Rgb(10, 20, 30);
    s.caustic = Rgb(100, 200, 300);
    s.albedo = Rgb(0.25, 0.5, 0.75);
    s.normal = Vec3(0, -1, 0);
    s.depth = 4;
    return s;
}

} // namespace

TEST(Film, PixelsAreMeansInEveryLayer) {
    Film film(3, 2);
    film.add(2, 1, full_sample());
    film.add(2, 1, PixelSample{});
    const Picture p = film.to_picture();
    EXPECT_EQ(p.width, 3);
    EXPECT_EQ(p.height, 2);
    EXPECT_THAT(pixel(p, "direct", 2, 1), ElementsAre(0.5f, 1, 1.5f));
    EXPECT_THAT(pixel(p, "indirect", 2, 1), ElementsAre(5, 10, 15));
    EXPECT_THAT(pixel(p, "caustic", 2, 1), ElementsAre(50, 100, 150));
    EXPECT_THAT(pixel(p, "beauty", 2, 1), ElementsAre(55.5f, 111, 166.5f));
    EXPECT_THAT(pixel(p, "albedo", 2, 1), ElementsAre(0.125f, 0.25f, 0.375f));
    EXPECT_THAT(pixel(p, "normal", 2, 1), ElementsAre(0, -0.5f, 0));
    EXPECT_THAT(pixel(p, "depth", 2, 1), ElementsAre(2));
    EXPECT_THAT(pixel(p, "beauty", 1, 1), ElementsAre(0, 0, 0));
}

// The square of what halves differ in is an estimate of the variance of the mean, whatever their sizes, and the two
// estimates that it makes of the mean are uncorrelated. Planted mistakes: the plain half of the difference, which is
// too large where sizes differ, and halves that are taken for equal.
TEST(Film, NoiseIsThatOfTheMean) {
    for (const int in_first : {1, 4, 7}) {
        constexpr int kPixels = 20'000, kSamples = 8;
        Film film(kPixels, 1);
        Rng rng(1, StreamPurpose::test, static_cast<std::uint64_t>(in_first));
        for (int x = 0; x < kPixels; ++x) {
            for (int i = 0; i < kSamples; ++i) {
                PixelSample s;
                s.indirect = Rgb(rng.next());
                s.depth = 3;
                film.add(x, 0, s, i < in_first ? Half::first : Half::second);
            }
        }
        const Picture p = film.to_picture();
        RunningStats mean, noise, product;
        for (int x = 0; x < kPixels; ++x) {
            const double m = p.layers.at("indirect").at(x, 0)[1], d = p.layers.at("noise.indirect").at(x, 0)[1];
            mean.add(m);
            noise.add(d * d);
            product.add((m + d - 0.5) * (m - d - 0.5));
            EXPECT_NEAR(p.layers.at("noise.depth").at(x, 0)[0], 0, 3 * 0x1p-11);
        }
        const double variance = 1.0 / 12 / kSamples;
        EXPECT_NEAR(mean.variance(), variance, 0.05 * variance) << in_first;
        EXPECT_NEAR(noise.mean(), variance, 4 * noise.standard_error()) << in_first;
        EXPECT_NEAR(product.mean(), 0, 4 * product.standard_error()) << in_first;
    }
}

TEST(Film, NoiseIsUnknownOfOneHalf) {
    Film film(1, 1);
    film.add(0, 0, full_sample(), Half::second);
    film.add(0, 0, PixelSample{}, Half::second);
    EXPECT_THAT(pixel(film.to_picture(), "noise.direct", 0, 0), ElementsAre(0, 0, 0));
}

// As everything that is saved and merged.
TEST(Film, NoiseDoesNotDependOnTheOrderOfSamples) {
    Rng rng(1, StreamPurpose::test, 5);
    std::vector<PixelSample> samples(100);
    for (PixelSample& s : samples) s.direct = Rgb(std::exp(8 * rng.next()), rng.next(), 1e-4 * rng.next());
    Film forward(1, 1), backward(1, 1), other(1, 1);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        forward.add(0, 0, samples[i], half_of(static_cast<std::int64_t>(i)));
        const std::size_t j = samples.size() - 1 - i;
        (i % 3 == 0 ? other : backward).add(0, 0, samples[j], half_of(static_cast<std::int64_t>(j)));
    }
    backward.merge(other);
    EXPECT_EQ(forward.words().data, backward.words().data);
}

TEST(Film, BadSamplesAreDroppedWholeAndCountedByLayer) {
    Film film(1, 1);
    film.add(0, 0, full_sample());
    PixelSample bad = full_sample();
    bad.direct.y = std::numeric_limits<double>::quiet_NaN();
    bad.depth = std::numeric_limits<double>::infinity();
    film.add(0, 0, bad);
    bad = full_sample();
    bad.caustic.z = -1e-30;
    film.add(0, 0, bad);

    EXPECT_THAT(pixel(film.to_picture(), "direct", 0, 0), ElementsAre(1, 2, 3));
    RenderStats stats;
    film.report(stats);
    ASSERT_EQ(stats.warnings.size(), 3u);
    EXPECT_THAT(stats.warnings[0], testing::AllOf(HasSubstr("1 sample"), HasSubstr("'direct'")));
    EXPECT_THAT(stats.warnings[1], HasSubstr("'caustic'"));
    EXPECT_THAT(stats.warnings[2], HasSubstr("'depth'"));
}

TEST(Film, EmptyPixelsAreCounted) {
    Film film(4, 3);
    film.add(0, 0, full_sample());
    RenderStats stats;
    film.report(stats);
    EXPECT_EQ(film.empty_pixels(), 11u);
    EXPECT_EQ(stats.no_samples, 11u);
    EXPECT_TRUE(stats.warnings.empty());
}

TEST(Film, SumsKeepSmallSamplesBesideLargeOnes) {
    Film film(1, 1);
    PixelSample s;
    s.direct = Rgb(1e6);
    film.add(0, 0, s);
    s.direct = Rgb(1e-3);
    for (int i = 0; i < 999'999; ++i) film.add(0, 0, s);
    EXPECT_FLOAT_EQ(pixel(film.to_picture(), "direct", 0, 0)[0], 1.001f);
}

TEST(Film, ThreadsMayAddToDifferentPixels) {
    constexpr int kPixels = 64;
    Film film(kPixels, 1);
    const auto add = [&](int first) {
        PixelSample bad = full_sample();
        bad.depth = -1;
        for (int i = 0; i < 1000; ++i)
            for (int x = first; x < kPixels; x += 2) film.add(x, 0, i % 2 == 0 ? full_sample() : bad);
    };
    std::thread other(add, 0);
    add(1);
    other.join();
    EXPECT_EQ(film.dropped(5), 500u * kPixels);
    EXPECT_EQ(film.empty_pixels(), 0u);
}
