#include "film/png.h"

#include "core/error.h"
#include "film/atomic_file.h"
#include "film/tonemap.h"

#include <fmt/format.h>
#include <png.h>

namespace keyhole {

void write_png(const std::string& path, const Image& image) {
    const auto pixels = tonemap(image);
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
        throw InputError(fmt::format("{}: cannot write: {}", path, png.message));
    write_file_atomically(path, {bytes.data(), size});
}

} // namespace keyhole
