// Pictures on disk: EXR, PNG, and what happens when the disk does not play along.
#include "core/error.h"
#include "film/files/atomic_file.h"
#include "film/files/exr.h"
#include "film/files/png.h"
#include "film/tonemap.h"
#include "support/scratch_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

using namespace keyhole;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

namespace {

namespace fs = std::filesystem;

/// Every float is another, awkward ones among them.
Image numbered(int width, int height, int channels, float first) {
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = first + static_cast<float>(i) / 3;
    image.data[0] = std::numeric_limits<float>::infinity();
    image.data[1] = std::numeric_limits<float>::denorm_min();
    return image;
}

Picture sample_picture() {
    Picture p;
    p.width = 5;
    p.height = 40; // more than one block of ZIP
    p.layers["beauty"] = numbered(5, 40, 3, 0);
    p.layers["direct"] = numbered(5, 40, 3, 1000);
    p.layers["normal"] = numbered(5, 40, 3, -500);
    p.layers["depth"] = numbered(5, 40, 1, 7);
    p.layers["grey"] = numbered(5, 40, 1, 1e9f);
    p.metadata = {{"command", "keyhole render 'a b.yaml'"},
                  {"seed", "1"},
                  {"a name much longer than thirty-one characters", "x\ny"},
                  {"empty", ""}};
    return p;
}

std::string read_all(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

std::size_t entries(const std::string& directory) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory), fs::directory_iterator()));
}

} // namespace

TEST(Exr, RoundTripKeepsEveryBitAndTheMetadata) {
    const ScratchDirectory scratch;
    const Picture p = sample_picture();
    write_exr(scratch.path("a.exr"), p);
    const Picture q = read_exr(scratch.path("a.exr"));
    EXPECT_EQ(q.width, p.width);
    EXPECT_EQ(q.height, p.height);
    EXPECT_EQ(q.metadata, p.metadata);
    ASSERT_EQ(q.layers.size(), p.layers.size());
    for (const auto& [name, image] : p.layers) {
        ASSERT_TRUE(q.layers.contains(name)) << name;
        EXPECT_EQ(q.layers.at(name).channels, image.channels) << name;
        EXPECT_EQ(q.layers.at(name).data, image.data) << name;
    }
}

TEST(Exr, ChannelsHaveTheNamesThatOthersExpect) {
    const ScratchDirectory scratch;
    write_exr(scratch.path("a.exr"), sample_picture());
    const std::string header = read_all(scratch.path("a.exr")).substr(0, 1000);
    for (const char* name : {"R", "direct.G", "normal.X", "depth.Z", "grey.Y"})
        EXPECT_THAT(header, HasSubstr(std::string("\0", 1) + name + '\0')) << name;
}

TEST(Exr, WritingIsAtomicAndFollowsLinks) {
    const ScratchDirectory scratch;
    scratch.write("old.exr", "old");
    fs::permissions(scratch.path("old.exr"), fs::perms(0640));
    fs::create_symlink("old.exr", scratch.path("link.exr"));
    write_exr(scratch.path("link.exr"), sample_picture());
    EXPECT_TRUE(fs::is_symlink(scratch.path("link.exr")));
    EXPECT_EQ(read_exr(scratch.path("old.exr")).layers.size(), 5u);
    EXPECT_EQ(fs::status(scratch.path("old.exr")).permissions(), fs::perms(0640));
    EXPECT_EQ(entries(scratch.path("")), 2u) << "a temporary file was left behind";
}

/// As the jobs of a chart do; for the thread sanitizer above all.
TEST(Exr, ThreadsMayWriteAtTheSameTime) {
    const ScratchDirectory scratch;
    const std::string content(100'000, 'x');
    std::vector<std::thread> threads;
    threads.reserve(4);
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 8; ++i)
                write_file_atomically(scratch.path(std::to_string(t)), content + std::to_string(i));
        });
    for (std::thread& t : threads) t.join();
    EXPECT_EQ(entries(scratch.path("")), 4u);
    for (int t = 0; t < 4; ++t) EXPECT_EQ(read_all(scratch.path(std::to_string(t))), content + "7");
}

TEST(Exr, WhatCannotBeWrittenIsNamed) {
    const ScratchDirectory scratch;
    const Picture p = sample_picture();
    const auto message = [&](const std::string& path, const std::string& reason) {
        EXPECT_THAT([&] { write_exr(path, p); }, ThrowsMessage<InputError>(AllOf(HasSubstr(path), HasSubstr(reason))));
    };
    message(scratch.path("missing/a.exr"), "No such file or directory");
    message(scratch.path(""), "Is a directory");
    message(scratch.write("file", "") + "/a.exr", "Not a directory");
    message("/proc/keyhole.exr", "/proc");
    if (fs::exists("/dev/full")) message("/dev/full", "No space left");
}

TEST(Exr, CheckWritableFindsTheSameAndLeavesNothing) {
    const ScratchDirectory scratch;
    EXPECT_THROW(check_writable(scratch.path("missing/a.exr")), InputError);
    EXPECT_THROW(check_writable(scratch.path("")), InputError);
    EXPECT_THROW(check_writable("/proc/keyhole.exr"), InputError);
    check_writable(scratch.path("a.exr"));
    EXPECT_EQ(entries(scratch.path("")), 0u);
}

TEST(Exr, WhatCannotBeReadIsNamed) {
    const ScratchDirectory scratch;
    write_exr(scratch.path("a.exr"), sample_picture());
    const std::string whole = read_all(scratch.path("a.exr"));
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{3}, std::size_t{60}, whole.size() / 2, whole.size() - 1}) {
        const std::string path = scratch.write("b.exr", whole.substr(0, size));
        EXPECT_THAT([&] { read_exr(path); }, ThrowsMessage<InputError>(HasSubstr(path + ": cannot read: ")))
            << size << " bytes";
    }
    EXPECT_THAT([&] { read_exr(scratch.write("c.exr", "not a picture at all")); },
                ThrowsMessage<InputError>(HasSubstr("c.exr")));
    EXPECT_THAT([&] { read_exr(scratch.path("none.exr")); }, ThrowsMessage<InputError>(HasSubstr("No such file")));
    EXPECT_THROW(read_exr(scratch.path("")), InputError);
}

TEST(Exr, AFlippedByteNeverCrashes) {
    const ScratchDirectory scratch;
    write_exr(scratch.path("a.exr"), sample_picture());
    const std::string whole = read_all(scratch.path("a.exr"));
    for (std::size_t i = 0; i < whole.size(); i += 7) {
        std::string broken = whole;
        broken[i] = static_cast<char>(broken[i] ^ 0x15);
        const std::string path = scratch.write("b.exr", broken);
        try {
            read_exr(path);
        } catch (const InputError&) {
        }
    }
}

TEST(Exr, LayersOfTheWrongSizeAreRefused) {
    const ScratchDirectory scratch;
    Picture p = sample_picture();
    p.layers["direct"] = Image(4, 4, 3);
    EXPECT_THROW(write_exr(scratch.path("a.exr"), p), InputError);
    p.layers["direct"] = Image(5, 40, 2);
    EXPECT_THROW(write_exr(scratch.path("a.exr"), p), InputError);
}

TEST(Tonemap, SrgbHasItsStandardValues) {
    EXPECT_EQ(srgb_encode(-1), 0);
    EXPECT_EQ(srgb_encode(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(srgb_encode(2), 1);
    EXPECT_NEAR(srgb_encode(0.001f), 0.01292, 1e-6);
    EXPECT_NEAR(srgb_encode(0.5f), 0.735357, 1e-5);
    EXPECT_NEAR(srgb_encode(0.18f), 0.461356, 1e-5);
}

TEST(Tonemap, UniformGreyBecomesTheKeyAtAnyBrightness) {
    // One luminance: scaled to the key 0.18, white point 1: 0.18 (1 + 0.18) / (1 + 0.18) = 0.18, which sRGB writes as
    // 118.
    for (const float brightness : {1e-6f, 1.0f, 1e6f}) {
        Image image(8, 8, 3);
        std::ranges::fill(image.data, brightness);
        for (const int byte : tonemap(image)) ASSERT_EQ(byte, 118);
    }
}

TEST(Tonemap, FollowsTheEquationsOfTheOperator) {
    // Luminances 1 and 100: log-average 10, scaled to 0.018 and 1.8. The percentile falls on the smaller one, so white
    // is 1.
    Image image(2, 1, 1);
    image.data = {1, 100};
    const auto bytes = tonemap(image);
    const double dark = 0.018 * (1 + 0.018) / (1 + 0.018);
    EXPECT_EQ(bytes[0], std::lround(255 * srgb_encode(static_cast<float>(dark))));
    EXPECT_EQ(bytes[3], 255);
}

TEST(Tonemap, BlackAndBrokenPixelsAreBlackAndLeaveTheRestAlone) {
    Image image(2, 2, 3);
    std::ranges::fill(image.data, 5.0f);
    std::fill_n(image.at(0, 0), 3, 0.0f);
    image.at(1, 0)[1] = std::numeric_limits<float>::quiet_NaN();
    image.at(0, 1)[2] = std::numeric_limits<float>::infinity();
    const auto bytes = tonemap(image);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(bytes[i], 0);
    for (std::size_t i = 9; i < 12; ++i) EXPECT_EQ(bytes[i], 118);
    EXPECT_EQ(tonemap(Image(3, 3, 3)), std::vector<std::uint8_t>(27, 0));
}

TEST(Tonemap, LampsBurnOutAndDontDimTheRest) {
    Image image(100, 100, 3);
    std::ranges::fill(image.data, 1.0f);
    const int before = tonemap(image)[300];
    for (int i = 0; i < 10; ++i) std::fill_n(image.at(i, 0), 3, 1e4f);
    EXPECT_EQ(tonemap(image)[0], 255);
    EXPECT_NEAR(tonemap(image)[300], before, 2);
}

TEST(Png, HoldsTheToneMappedPixels) {
    const ScratchDirectory scratch;
    Image image(7, 4, 3);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i % 11) / 5;
    write_png(scratch.path("a.png"), image);
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&png, scratch.path("a.png").c_str()), 0) << png.message;
    png.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(png));
    ASSERT_NE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr), 0) << png.message;
    EXPECT_EQ(png.width, 7u);
    EXPECT_EQ(png.height, 4u);
    EXPECT_EQ(bytes, tonemap(image));
    EXPECT_THROW(write_png(scratch.path("missing/a.png"), image), InputError);
}
