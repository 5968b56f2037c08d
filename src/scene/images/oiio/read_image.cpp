#include "scene/images/oiio/read_image.h"

#include <OpenImageIO/imageio.h>

namespace {

using namespace keyhole;

/// Colours without their alpha: one channel, or the first three.
int picture_channels(const OIIO::ImageSpec& spec) { return spec.nchannels < 3 ? 1 : 3; }

template <class Texels>
bool read_texels(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, TextureImage& image) {
    auto& texels = image.allocate<Texels>(spec.width, spec.height, picture_channels(spec));
    return input.read_image(0, 0, 0, image.channels, type, texels.data());
}

bool read(OIIO::ImageInput& input, TextureImage& image, std::string& error) {
    const OIIO::ImageSpec& spec = input.spec();
    if (spec.width < 1 || spec.height < 1 || spec.width > kMaxImageSide || spec.height > kMaxImageSide ||
        std::int64_t{spec.width} * spec.height > kMaxImagePixels || spec.nchannels < 1 || spec.depth > 1) {
        error = "found an empty or a huge image, expected at most 65536 pixels a side and 2^28 together";
        return false;
    }
    bool fine = false;
    switch (spec.format.basetype) {
    case OIIO::TypeDesc::UINT8:
        fine = read_texels<TextureImage::Bytes>(input, spec, OIIO::TypeDesc::UINT8, image);
        break;
    case OIIO::TypeDesc::UINT16:
        fine = read_texels<TextureImage::Words>(input, spec, OIIO::TypeDesc::UINT16, image);
        break;
    default:
        fine = read_texels<TextureImage::Floats>(input, spec, OIIO::TypeDesc::FLOAT, image);
    }
    if (!fine) error = input.geterror();
    return fine;
}

} // namespace

namespace keyhole {

extern "C" bool keyhole_read_image(const std::string& path, TextureImage& image, std::string& error) noexcept {
    try {
        // Colours of pictures with alpha as they are, not multiplied by it.
        OIIO::ImageSpec wish;
        wish["oiio:UnassociatedAlpha"] = 1;
        const auto input = OIIO::ImageInput::open(path, &wish);
        if (input == nullptr) {
            error = OIIO::geterror();
            return false;
        }
        return read(*input, image, error);
    } catch (const std::exception& e) {
        error = e.what();
    } catch (...) {
        error = "OpenImageIO failed";
    }
    return false;
}

} // namespace keyhole
