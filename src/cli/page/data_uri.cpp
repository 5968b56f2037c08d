#include "cli/page/data_uri.h"

#include "core/base64.h"
#include "film/files/png.h"

namespace keyhole {

std::string png_uri(int width, int height, int channels, const std::vector<std::uint8_t>& pixels) {
    return "data:image/png;base64," + to_base64(png_bytes(width, height, channels, pixels));
}

} // namespace keyhole
