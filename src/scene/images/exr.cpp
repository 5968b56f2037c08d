#include "core/error.h"
#include "scene/images/image.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

namespace keyhole {
namespace {

/// The channels that make up the picture: R, G, B; or Y; or the only one there is.
std::vector<std::string> picture_channels(const Imf::ChannelList& channels, const std::string& path) {
    if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B")) return {"R", "G", "B"};
    if (channels.findChannel("Y") && !channels.findChannel("RY")) return {"Y"};
    std::vector<std::string> all;
    for (auto c = channels.begin(); c != channels.end(); ++c) all.emplace_back(c.name());
    if (all.size() == 1) return all;
    throw InputError(path + ": found neither the channels R, G, B nor a single one, expected either");
}

} // namespace

TextureImage read_exr_image(const std::string& path, ImagePart part) {
    try {
        Imf::InputFile file(path.c_str(), 1);
        const Imath::Box2i& window = file.header().dataWindow();
        const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
        const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
        check_image_size(path, width, height);
        const Imf::ChannelList& channels = file.header().channels();
        if (part == ImagePart::alpha && channels.findChannel("A") == nullptr) return opaque_image();
        const auto names = part == ImagePart::alpha ? std::vector<std::string>{"A"} : picture_channels(channels, path);
        TextureImage image;
        auto& texels = image.allocate<TextureImage::Floats>(static_cast<int>(width), static_cast<int>(height),
                                                            static_cast<int>(names.size()));
        Imf::FrameBuffer buffer;
        const std::size_t pixel = names.size() * sizeof(float), row = pixel * static_cast<std::size_t>(width);
        for (std::size_t i = 0; i < names.size(); ++i)
            buffer.insert(names[i], Imf::Slice::Make(Imf::FLOAT, &texels[i], window, pixel, row));
        file.setFrameBuffer(buffer);
        file.readPixels(window.min.y, window.max.y);
        return image;
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& e) {
        throw InputError(path + ": " + e.what());
    }
}

} // namespace keyhole
