// Bias and variance, apart: pictures of known bias and noise, against references with noise of their own.
#include "core/error.h"
#include "core/rng.h"
#include "film/image_error.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace keyhole;

namespace {

constexpr int kSize = 96;

/// 1 to 2 from left to right, times `scale`, with uniform noise of deviation `sigma`.
Image picture(double scale, double sigma, std::uint64_t stream) {
    Rng rng(1, StreamPurpose::test, stream);
    Image image(kSize, kSize, 1);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            *image.at(x, y) = static_cast<float>(scale * (1 + static_cast<double>(x) / kSize) +
                                                 sigma * std::sqrt(12.0) * (rng.next() - 0.5));
    return image;
}

/// Mean of numerator(R) / (R^2 + 0.01 mean(R)^2) over the ramp.
template <class F> double relative(F&& numerator) {
    double sum = 0;
    for (int x = 0; x < kSize; ++x) {
        const double r = 1 + static_cast<double>(x) / kSize;
        sum += numerator(r) / (r * r + 0.01 * 1.5 * 1.5);
    }
    return sum / kSize;
}

} // namespace

TEST(RepeatError, ToldApartBiasAndVarianceAreThoseOfThePictures) {
    std::vector<Image> repeats;
    for (std::uint64_t k = 0; k < 8; ++k) repeats.push_back(picture(1.1, 0.2, 10 + k));
    const Image a = picture(1, 0.3, 1), b = picture(1, 0.3, 2);
    const RepeatError e = repeat_error(repeats, a, &b);
    const double bias = relative([](double r) { return 0.01 * r * r; });
    const double variance = relative([](double) { return 0.04; });
    EXPECT_NEAR(e.bias, bias, 0.12 * bias);
    EXPECT_NEAR(e.variance, variance, 0.03 * variance);
    EXPECT_DOUBLE_EQ(e.error, e.bias + e.variance);
    ASSERT_EQ(e.each.size(), 8u);
    double mean = 0;
    for (const double each : e.each) mean += each / 8;
    EXPECT_NEAR(mean, e.error, 1e-12);
}

TEST(RepeatError, OfOnePictureIsItsCrossTrimAndHasNoParts) {
    const Image image = picture(1.2, 0.5, 3), a = picture(1, 0.3, 1), b = picture(1, 0.3, 2);
    const RepeatError e = repeat_error({image}, a, &b);
    EXPECT_NEAR(e.error, *image_error(image, a, &b).cross_trim, 1e-12);
    EXPECT_TRUE(std::isnan(e.bias) && std::isnan(e.variance));
}

TEST(RepeatError, BadPixelsCountAsBlackAndSizesMustAgree) {
    Image image = picture(1, 0, 3), black = image;
    const Image reference = picture(1, 0, 1);
    *image.at(5, 5) = NAN;
    *black.at(5, 5) = 0;
    EXPECT_EQ(repeat_error({image}, reference, nullptr).error, repeat_error({black}, reference, nullptr).error);
    EXPECT_THROW(repeat_error({Image(3, 3, 1)}, reference, nullptr), InputError);
}
