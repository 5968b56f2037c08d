// Truevision TGA: grey or true colour, plain or run-length packed.
#include "core/error.h"
#include "scene/images/image.h"

#include <fstream>
#include <iterator>

namespace keyhole {
namespace {

constexpr std::size_t kHeaderBytes = 18;

struct Header {
    std::size_t skip = 0; ///< bytes between header and pixels
    int kind = 0, width = 0, height = 0, bits = 0;
    bool from_top = false, from_right = false;

    bool packed() const { return kind >= 9; }
    int stored_channels() const { return bits / 8; }
    int channels() const { return bits == 8 ? 1 : 3; }
};

Header parse_header(const std::vector<std::uint8_t>& file) {
    const auto word = [&](std::size_t i) { return file[i] | file[i + 1] << 8; };
    Header h;
    h.kind = file[2];
    h.skip = kHeaderBytes + file[0];
    h.width = word(12);
    h.height = word(14);
    h.bits = file[16];
    h.from_right = (file[17] & 0x10) != 0;
    h.from_top = (file[17] & 0x20) != 0;
    return h;
}

/// Kinds 2 and 10 are true colour, 3 and 11 grey; palettes and 16-bit colours are left to others.
bool is_plain(const std::vector<std::uint8_t>& file, const Header& h) {
    const bool color = (h.kind & ~8) == 2 && (h.bits == 24 || h.bits == 32), grey = (h.kind & ~8) == 3 && h.bits == 8;
    return file[1] == 0 && (color || grey);
}

/// Pixels in the order of the file, unpacked. @throws InputError where the file ends before them.
std::vector<std::uint8_t> unpack(const std::string& path, const std::vector<std::uint8_t>& file, const Header& h) {
    const auto pixel = static_cast<std::size_t>(h.stored_channels());
    const std::size_t size = static_cast<std::size_t>(h.width) * static_cast<std::size_t>(h.height) * pixel;
    std::size_t at = h.skip;
    const auto need = [&](std::size_t bytes) {
        if (at > file.size() || file.size() - at < bytes)
            throw InputError(path + ": found the end of the file, expected more pixels");
    };
    const auto from = [&] { return file.begin() + static_cast<std::ptrdiff_t>(at); };
    need(h.packed() ? size / 128 : size); // before room is made for pixels that aren't there
    if (!h.packed()) return {from(), from() + static_cast<std::ptrdiff_t>(size)};
    std::vector<std::uint8_t> raw;
    raw.reserve(size);
    while (raw.size() < size) {
        need(1);
        const std::size_t count = (file[at] & 0x7Fu) + 1;
        const bool run = (file[at++] & 0x80u) != 0;
        need(run ? pixel : count * pixel);
        for (std::size_t i = 0; run && i < count; ++i) raw.insert(raw.end(), from(), from() + h.stored_channels());
        if (!run) raw.insert(raw.end(), from(), from() + static_cast<std::ptrdiff_t>(count * pixel));
        at += run ? pixel : count * pixel;
    }
    return raw; // a last run may reach too far
}

} // namespace

TextureImage read_tga_image(const std::string& path, ImagePart part) {
    std::ifstream stream(path, std::ios::binary);
    const std::vector<std::uint8_t> file{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (file.size() < kHeaderBytes) throw InputError(path + ": found no TGA header, expected 18 bytes of it");
    const Header h = parse_header(file);
    if (!is_plain(file, h) || (part == ImagePart::alpha && h.bits == 32)) return read_other_image(path, part);
    if (part == ImagePart::alpha) return opaque_image();
    check_image_size(path, h.width, h.height);
    const std::vector<std::uint8_t> raw = unpack(path, file, h);

    TextureImage image;
    auto& texels = image.allocate<TextureImage::Bytes>(h.width, h.height, h.channels());
    const std::uint8_t* in = raw.data();
    for (int j = 0; j < h.height; ++j) {
        for (int i = 0; i < h.width; ++i, in += h.stored_channels()) {
            const int x = h.from_right ? h.width - 1 - i : i, y = h.from_top ? j : h.height - 1 - j;
            const std::size_t out =
                (static_cast<std::size_t>(y) * static_cast<std::size_t>(h.width) + static_cast<std::size_t>(x)) *
                static_cast<std::size_t>(h.channels());
            for (int c = 0; c < h.channels(); ++c) // stored as blue, green, red
                texels[out + static_cast<std::size_t>(c)] = in[h.channels() - 1 - c];
        }
    }
    return image;
}

} // namespace keyhole
