#include "film/files/png.h"

#include "core/error.h"
#include "film/files/atomic_file.h"
#include "film/tonemap.h"

#include <fmt/format.h>
#include <png.h>

namespace keyhole {

void write_png(const std::string& path, const Image& image, std::optional<double> stops) {
    write_png(path, Canvas{image.width, image.height, stops ? expose_by(image, *stops) : tonemap(image)});
}

void write_png(const std::string& path, const Canvas& canvas) {
    const std::string bytes = png_bytes(canvas.width, canvas.height, 3, canvas.pixels);
    write_file_atomically(path, {bytes.data(), bytes.size()});
}

std::string png_bytes(int width, int height, int channels, const std::vector<std::uint8_t>& pixels) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(width);
    png.height = static_cast<png_uint_32>(height);
    png.format = channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
        throw InputError(fmt::format("cannot make a PNG: {}", png.message));
    bytes.resize(size);
    return bytes;
}

} // namespace keyhole
