// Portable float maps: a text header, then floats from the bottom row upwards.
#include "core/error.h"
#include "scene/images/image.h"

#include <bit>
#include <filesystem>
#include <fstream>

namespace keyhole {
namespace {

float swapped(float x) { return std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(x))); }

} // namespace

TextureImage read_pfm_image(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string magic;
    std::int64_t width = 0, height = 0;
    double scale = 0;
    file >> magic >> width >> height >> scale;
    if (!file || (magic != "PF" && magic != "Pf") || scale == 0)
        throw InputError(path + ": found no PFM header, expected PF or Pf, width, height and scale");
    check_image_size(path, width, height);
    file.get(); // one white space ends the header

    // Before room is made for pixels that aren't there.
    const std::int64_t channels = magic == "PF" ? 3 : 1, size = width * height * channels * std::int64_t{sizeof(float)};
    std::error_code error;
    if (static_cast<std::int64_t>(std::filesystem::file_size(path, error)) - file.tellg() < size)
        throw InputError(path + ": found the end of the file, expected more pixels");

    TextureImage image;
    auto& texels =
        image.allocate<TextureImage::Floats>(static_cast<int>(width), static_cast<int>(height), magic == "PF" ? 3 : 1);
    const auto row = static_cast<std::size_t>(width * image.channels);
    for (auto y = static_cast<std::size_t>(height); y-- > 0;)
        file.read(reinterpret_cast<char*>(&texels[y * row]), static_cast<std::streamsize>(row * sizeof(float)));
    if (!file) throw InputError(path + ": can't be read");
    // The sign of the scale tells the order of bytes; its size means nothing to most programs, and nothing here.
    if ((scale < 0) != (std::endian::native == std::endian::little))
        for (float& x : texels) x = swapped(x);
    return image;
}

} // namespace keyhole
