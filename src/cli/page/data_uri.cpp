#include "cli/page/data_uri.h"

#include "film/files/png.h"

namespace keyhole {

std::string base64(const std::string& bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(bytes.size() / 3 * 4 + 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < have ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= have ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

std::string png_uri(int width, int height, int channels, const std::vector<std::uint8_t>& pixels) {
    return "data:image/png;base64," + base64(png_bytes(width, height, channels, pixels));
}

} // namespace keyhole
