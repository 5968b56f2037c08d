// Images from files, as they are stored: 8-bit ones stay 8 bits.
#pragma once

#include "core/vec.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace keyhole {

/// What of a file's picture is read: its colours, or their alpha as one channel.
enum class ImagePart { colors, alpha };

/// One or three channels, row by row from the top. Integers hold what the file holds, of 255 or 65535;
/// floats are linear.
struct TextureImage {
    using Bytes = std::vector<std::uint8_t>;
    using Words = std::vector<std::uint16_t>;
    using Floats = std::vector<float>;

    int width = 0, height = 0, channels = 0;
    std::variant<Bytes, Words, Floats> texels;
    std::uint64_t hash = 0; ///< of all that, set by load_image()

    /// Makes room for width * height * channels texels of a kind.
    template <class Texels> Texels& allocate(int w, int h, int n) {
        width = w;
        height = h;
        channels = n;
        const auto size = static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(n);
        return texels.emplace<Texels>(size);
    }
    std::size_t bytes() const;
};

/// Of a value in [0,1] (IEC 61966-2-1).
inline double srgb_to_linear(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }

constexpr int kMaxImageSide = 1 << 16;
constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 28;

/// Fails unless an image of this size is one that we are ready to hold. @throws InputError
void check_image_size(const std::string& path, std::int64_t width, std::int64_t height);

/// The image of a file, from a cache while anybody holds it: EXR, PFM, TGA and JPEG, and what OpenImageIO reads, which
/// is loaded when first needed, because it costs a third of a second and 130 MB. The alpha of a file without any is one
/// texel of 1.
/// @throws InputError "path: what is wrong"
std::shared_ptr<const TextureImage> load_image(const std::string& path, ImagePart part = ImagePart::colors);

// The readers behind load_image(), by kind of file.
TextureImage read_exr_image(const std::string& path, ImagePart part);
TextureImage read_pfm_image(const std::string& path);
TextureImage read_tga_image(const std::string& path, ImagePart part);
TextureImage read_jpeg_image(const std::string& path);
TextureImage read_other_image(const std::string& path, ImagePart part = ImagePart::colors);
/// The alpha of a file without any.
inline TextureImage opaque_image() {
    TextureImage image;
    image.allocate<TextureImage::Bytes>(1, 1, 1)[0] = 255;
    return image;
}

} // namespace keyhole
