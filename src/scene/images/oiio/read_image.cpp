#include "scene/images/oiio/read_image.h"

#include <OpenImageIO/imageio.h>

namespace {

using namespace keyhole;

/// Channels of a file.
struct Channels {
    int first, count;
};

/// Colours without their alpha, one channel or the first three; or that alone.
Channels channels_of(const OIIO::ImageSpec& spec, ImagePart part) {
    if (part == ImagePart::alpha) return {spec.alpha_channel, 1};
    return {0, spec.nchannels < 3 ? 1 : 3};
}

template <class Texels>
bool read_texels(OIIO::ImageInput& input, OIIO::TypeDesc type, const Channels& channels, TextureImage& image) {
    const OIIO::ImageSpec& spec = input.spec();
    auto& texels = image.allocate<Texels>(spec.width, spec.height, channels.count);
    return input.read_image(0, 0, channels.first, channels.first + channels.count, type, texels.data());
}

bool read(OIIO::ImageInput& input, ImagePart part, TextureImage& image, std::string& error) {
    const OIIO::ImageSpec& spec = input.spec();
    if (part == ImagePart::alpha && spec.alpha_channel < 0) {
        image = opaque_image();
        return true;
    }
    const Channels channels = channels_of(spec, part);
    if (spec.width < 1 || spec.height < 1 || spec.width > kMaxImageSide || spec.height > kMaxImageSide ||
        std::int64_t{spec.width} * spec.height > kMaxImagePixels || spec.nchannels < 1 || spec.depth > 1) {
        error = "found an empty or a huge image, expected at most 65536 pixels a side and 2^28 together";
        return false;
    }
    bool fine = false;
    switch (spec.format.basetype) {
    case OIIO::TypeDesc::UINT8:
        fine = read_texels<TextureImage::Bytes>(input, OIIO::TypeDesc::UINT8, channels, image);
        break;
    case OIIO::TypeDesc::UINT16:
        fine = read_texels<TextureImage::Words>(input, OIIO::TypeDesc::UINT16, channels, image);
        break;
    default:
        fine = read_texels<TextureImage::Floats>(input, OIIO::TypeDesc::FLOAT, channels, image);
    }
    if (!fine) error = input.geterror();
    return fine;
}

} // namespace

namespace keyhole {

extern "C" bool keyhole_read_image_part(const std::string& path, ImagePart part, TextureImage& image,
                                        std::string& error) noexcept {
    try {
        // Colours of pictures with alpha as they are, not multiplied by it.
        OIIO::ImageSpec wish;
        wish["oiio:UnassociatedAlpha"] = 1;
        const auto input = OIIO::ImageInput::open(path, &wish);
        if (input == nullptr) {
            error = OIIO::geterror();
            return false;
        }
        return read(*input, part, image, error);
    } catch (const std::exception& e) {
        error = e.what();
    } catch (...) {
        error = "OpenImageIO failed";
    }
    return false;
}

} // namespace keyhole
