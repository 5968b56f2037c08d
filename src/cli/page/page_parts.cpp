#include "cli/page/page_parts.h"

#include "core/base64.h"
#include "film/files/png.h"

namespace keyhole {

std::string PageParts::with(std::string data) const {
    // A script element ends at the first "</".
    for (std::size_t at = 0; (at = data.find("</", at)) != std::string::npos;) data.replace(at, 2, "<\\/");
    return std::string(before_data) + data + std::string(after_data);
}

std::string png_uri(int width, int height, int channels, const std::vector<std::uint8_t>& pixels) {
    return "data:image/png;base64," + to_base64(png_bytes(width, height, channels, pixels));
}

} // namespace keyhole
