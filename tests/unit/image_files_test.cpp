// Our readers of TGA and JPEG see what OpenImageIO sees, and stop at what is broken.
#include "core/error.h"
#include "scene/images/image.h"
#include "support/scratch_directory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace keyhole {
namespace {

void expect_same(const TextureImage& a, const TextureImage& b) {
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.texels, b.texels);
}

/// A TGA header for 5 x 3 pixels.
std::string tga_header(int kind, int bits, int descriptor) {
    std::string h(18, '\0');
    h[2] = static_cast<char>(kind);
    h[12] = 5;
    h[14] = 3;
    h[16] = static_cast<char>(bits);
    h[17] = static_cast<char>(descriptor);
    return h;
}

std::string counting(int bytes) {
    std::string s;
    for (int i = 0; i < bytes; ++i) s += static_cast<char>(i * 7 + 3);
    return s;
}

/// Two runs and a literal: 6 + 5 + 4 pixels.
std::string packed(int pixel) {
    const std::string p = counting(7 * pixel);
    return '\x85' + p.substr(0, static_cast<std::size_t>(pixel)) + '\x84' +
           p.substr(static_cast<std::size_t>(pixel), static_cast<std::size_t>(pixel)) + '\x03' +
           p.substr(static_cast<std::size_t>(2 * pixel), static_cast<std::size_t>(4 * pixel));
}

TEST(ImageFiles, TgaIsReadAsOpenImageIoDoes) {
    const ScratchDirectory d;
    for (const int origin : {0, 0x20}) {
        for (const auto& [kind, bits] : {std::pair(2, 24), std::pair(2, 32), std::pair(3, 8)}) {
            const int alpha = bits == 32 ? 8 : 0, pixel = bits / 8;
            const std::string plain = d.write("a.tga", tga_header(kind, bits, origin | alpha) + counting(15 * pixel));
            expect_same(read_tga_image(plain, ImagePart::colors), read_other_image(plain));
            const std::string runs = d.write("b.tga", tga_header(kind + 8, bits, origin | alpha) + packed(pixel));
            expect_same(read_tga_image(runs, ImagePart::colors), read_other_image(runs));
        }
    }
}

TEST(ImageFiles, TruncatedTgaIsAnError) {
    const ScratchDirectory d;
    for (const std::string& whole : {tga_header(2, 24, 0) + counting(45), tga_header(10, 24, 0) + packed(3)})
        for (std::size_t n = 0; n < whole.size(); ++n)
            EXPECT_THROW(read_tga_image(d.write("cut.tga", whole.substr(0, n)), ImagePart::colors), InputError) << n;
}

TEST(ImageFiles, JpegIsReadAsOpenImageIoDoes) {
    const std::string path = std::string(KEYHOLE_SOURCE_DIR) + "/tests/data/ramp.jpg";
    const TextureImage image = read_jpeg_image(path);
    EXPECT_EQ(image.width, 40);
    expect_same(image, read_other_image(path));
}

TEST(ImageFiles, BrokenJpegIsAnError) {
    std::ifstream file(std::string(KEYHOLE_SOURCE_DIR) + "/tests/data/ramp.jpg", std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const ScratchDirectory d;
    for (std::size_t n = 0; n + 2 < whole.size(); n += 13) // the marker of the end may be missing
        EXPECT_THROW(read_jpeg_image(d.write("cut.jpg", whole.substr(0, n))), InputError) << n;
    EXPECT_THROW(read_jpeg_image(d.write("junk.jpg", "GIF89a")), InputError);
    EXPECT_THROW(read_jpeg_image(d.path("none.jpg")), InputError);
}

} // namespace
} // namespace keyhole
