// Error measures against values computed by hand, and against an independent implementation where there is one.
#include "core/error.h"
#include "core/rng.h"
#include "film/files/exr.h"
#include "film/image_error.h"
#include "support/scratch_directory.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

using namespace keyhole;

namespace {

Image uniform(int width, int height, float value) {
    Image image(width, height, 1);
    std::ranges::fill(image.data, value);
    return image;
}

/// Exponentially distributed noise around a gradient, with a few outliers and bad pixels.
Image noisy(int width, int height, std::uint64_t stream) {
    Rng rng(1, StreamPurpose::test, stream);
    Image image(width, height, 3);
    for (std::size_t i = 0; i < image.data.size(); ++i)
        image.data[i] = static_cast<float>((1 + 5.0 * static_cast<double>(i) / static_cast<double>(image.data.size())) *
                                           -std::log(1 - rng.next()));
    return image;
}

Picture as_picture(const Image& image) {
    Picture p;
    p.width = image.width;
    p.height = image.height;
    p.layers["beauty"] = image;
    // Other layers must not confuse a reader of R, G and B.
    p.layers["direct"] = Image(image.width, image.height, 3);
    p.layers["albedo"] = Image(image.width, image.height, 3);
    return p;
}

std::string output_of(const std::string& command) {
    std::string text;
    std::FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 256> buffer{};
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) text += buffer.data();
    return pclose(pipe) == 0 ? text : "";
}

} // namespace

TEST(ImageError, OfAScaledUniformPicture) {
    const ImageError e = image_error(uniform(32, 48, 3), uniform(32, 48, 2));
    EXPECT_NEAR(e.relmse, 1.0 / (4 + 0.04), 1e-12);
    EXPECT_NEAR(e.relmse_trim, 1.0 / (4 + 0.04), 1e-12);
    EXPECT_DOUBLE_EQ(e.rms_rel, 0.5);
    EXPECT_DOUBLE_EQ(e.ratio, 1.5);
    EXPECT_DOUBLE_EQ(e.block, 0.5);
    EXPECT_EQ(e.bad, 0u);
    EXPECT_FALSE(e.cross.has_value());
}

TEST(ImageError, TrimLeavesOutTheWorstThousandth) {
    Image picture = uniform(100, 20, 1);
    picture.data[77] = 101;
    picture.data[1234] = -49;
    picture.data[1999] = 11; // the third worst of 2000 stays
    const ImageError e = image_error(picture, uniform(100, 20, 1));
    EXPECT_NEAR(e.relmse, (100.0 * 100 + 50 * 50 + 10 * 10) / 1.01 / 2000, 1e-12);
    EXPECT_NEAR(e.relmse_trim, 10.0 * 10 / 1.01 / 1998, 1e-12);
    EXPECT_EQ(e.bad, 1u);
}

TEST(ImageError, DarkPixelsStayOutOfTheRelativeError) {
    Image reference = uniform(16, 16, 1);
    reference.data[0] = 1e-6f;
    Image picture = uniform(16, 16, 1.25f);
    picture.data[0] = 1000;
    EXPECT_DOUBLE_EQ(image_error(picture, reference).rms_rel, 0.25);
}

TEST(ImageError, BadPixelsAreCountedAndReadAsBlack) {
    Image picture = uniform(16, 16, 1);
    picture.data[3] = std::numeric_limits<float>::quiet_NaN();
    picture.data[4] = -std::numeric_limits<float>::infinity();
    const ImageError e = image_error(picture, uniform(16, 16, 1));
    EXPECT_EQ(e.bad, 2u);
    EXPECT_DOUBLE_EQ(e.ratio, 254.0 / 256);
}

TEST(ImageError, CrossIsFreeOfTheReferencesNoise) {
    Image a = uniform(48, 48, 1), b = a, picture = a;
    for (std::size_t i = 0; i < a.data.size(); ++i) {
        a.data[i] += i % 2 == 0 ? 0.5f : -0.5f; // noise of one reference only
    }
    const ImageError e = image_error(picture, a, &b);
    EXPECT_EQ(*e.cross, 0);
    EXPECT_GT(e.relmse, 0.05);
}

/// A property of the definition, kept because figures from elsewhere have it.
TEST(ImageError, BlocksBlackInBothCountAsWrong) {
    Image image = uniform(32, 16, 1);
    for (int y = 0; y < 16; ++y) std::fill_n(image.at(0, y), 16, 0.0f);
    EXPECT_DOUBLE_EQ(image_error(image, image).block, std::sqrt(0.5));
    EXPECT_EQ(image_error(image, image).relmse, 0);
}

TEST(ImageError, NothingToMeasureIsNotANumber) {
    const ImageError dark = image_error(uniform(16, 16, 1), uniform(16, 16, 0));
    EXPECT_TRUE(std::isnan(dark.rms_rel));
    EXPECT_TRUE(std::isnan(image_error(uniform(5, 5, 1), uniform(5, 5, 1)).block));
}

TEST(ImageError, SizesMustAgree) {
    const Image third = uniform(2, 3, 1);
    EXPECT_THROW(image_error(uniform(2, 3, 1), uniform(3, 2, 1)), InputError);
    EXPECT_THROW(image_error(uniform(3, 2, 1), uniform(3, 2, 1), &third), InputError);
}

TEST(ImageError, AgreesWithAnIndependentImplementation) {
    const char* script = std::getenv("KEYHOLE_PICTURE_ERROR");
    if (script == nullptr) GTEST_SKIP() << "KEYHOLE_PICTURE_ERROR names no script that prints the same measures";
    const ScratchDirectory scratch;
    Image picture = noisy(70, 53, 1);
    const auto blacken = [](Image& image) {
        for (int y = 16; y < 32; ++y) std::fill_n(image.at(32, y), 3 * 16, 0.0f);
    };
    blacken(picture);
    picture.data[300] = 5000;
    picture.data[3000] = -5;
    picture.data[301] = std::numeric_limits<float>::quiet_NaN();
    Image r1 = noisy(70, 53, 2), r2 = noisy(70, 53, 3);
    blacken(r1);
    blacken(r2);
    std::string command = script;
    for (const auto& [name, image] :
         std::vector<std::pair<const char*, const Image*>>{{"i.exr", &picture}, {"r1.exr", &r1}, {"r2.exr", &r2}}) {
        write_exr(scratch.path(name), as_picture(*image));
        command += ' ';
        command += scratch.path(name);
    }
    const auto expected = nlohmann::json::parse(output_of(command));
    const ImageError e = image_error(picture, r1, &r2);
    const auto expect = [&](const char* key, double value) {
        EXPECT_NEAR(value / expected.at(key).get<double>(), 1, 1e-9) << key;
    };
    expect("relmse", e.relmse);
    expect("relmse_trim", e.relmse_trim);
    expect("rms_rel", e.rms_rel);
    expect("ratio", e.ratio);
    expect("block", e.block);
    expect("bad", static_cast<double>(e.bad));
    expect("cross", *e.cross);
    expect("cross_trim", *e.cross_trim);
}
