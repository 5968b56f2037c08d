// JPEG, by libjpeg.
#include "core/error.h"
#include "scene/images/image.h"

#include <csetjmp>
#include <cstdio>
#include <memory>

#include <jpeglib.h>

namespace keyhole {
namespace {

/// libjpeg's errors end in its caller: C++ exceptions can't cross its C frames.
struct ErrorManager {
    jpeg_error_mgr base;
    std::jmp_buf caller;
    char message[JMSG_LENGTH_MAX];
};

void leave(j_common_ptr decoder) {
    auto* errors = reinterpret_cast<ErrorManager*>(decoder->err);
    decoder->err->format_message(decoder, errors->message);
    std::longjmp(errors->caller, 1);
}

enum class Outcome { fine, broken, other_colors };

/// Holds no object of its own that needs a destructor, since errors jump out of it.
Outcome decode(std::FILE* file, jpeg_decompress_struct& decoder, ErrorManager& errors, TextureImage& image,
               const std::string& path) {
    if (setjmp(errors.caller) != 0) return Outcome::broken;
    jpeg_create_decompress(&decoder);
    jpeg_stdio_src(&decoder, file);
    jpeg_read_header(&decoder, TRUE);
    if (decoder.num_components != 1 && decoder.num_components != 3) return Outcome::other_colors;
    decoder.out_color_space = decoder.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    check_image_size(path, decoder.image_width, decoder.image_height);
    jpeg_start_decompress(&decoder);
    auto& texels = image.allocate<TextureImage::Bytes>(
        static_cast<int>(decoder.output_width), static_cast<int>(decoder.output_height), decoder.output_components);
    const std::size_t row = std::size_t{decoder.output_width} * static_cast<std::size_t>(decoder.output_components);
    while (decoder.output_scanline < decoder.output_height) {
        JSAMPROW at = texels.data() + decoder.output_scanline * row;
        jpeg_read_scanlines(&decoder, &at, 1);
    }
    jpeg_finish_decompress(&decoder);
    return Outcome::fine;
}

} // namespace

TextureImage read_jpeg_image(const std::string& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (file == nullptr) throw InputError(path + ": can't be read");
    ErrorManager errors{};
    jpeg_decompress_struct decoder{};
    decoder.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = leave;
    errors.base.output_message = [](j_common_ptr) {}; // warnings are counted
    const std::unique_ptr<jpeg_decompress_struct, void (*)(jpeg_decompress_struct*)> owner(
        &decoder, [](jpeg_decompress_struct* d) { jpeg_destroy_decompress(d); });
    TextureImage image;
    switch (decode(file.get(), decoder, errors, image, path)) {
    case Outcome::broken:
        throw InputError(path + ": found a broken JPEG file: " + errors.message);
    case Outcome::other_colors:
        return read_other_image(path);
    case Outcome::fine:
        break;
    }
    if (errors.base.num_warnings > 0) throw InputError(path + ": found a broken JPEG file, expected one that is whole");
    return image;
}

} // namespace keyhole
