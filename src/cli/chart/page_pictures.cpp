#include "cli/chart/page_pictures.h"

#include "cli/page/data_uri.h"
#include "film/grey.h"
#include "film/tonemap.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

Image shrunk(const Image& image, int factor) {
    if (factor == 1) return image;
    Image small(image.width / factor, image.height / factor, image.channels);
    const float share = 1 / static_cast<float>(factor * factor);
    for (int y = 0; y < small.height * factor; ++y)
        for (int x = 0; x < small.width * factor; ++x)
            for (int k = 0; k < image.channels; ++k) small.at(x / factor, y / factor)[k] += share * image.at(x, y)[k];
    return small;
}

std::string picture_uri(const Image& image, const Image& reference) {
    return png_uri(image.width, image.height, 3, tonemap(image, reference));
}

std::string error_uri(const Image& image, const Image& reference) {
    const Grey i(image), r(reference);
    const double floor = 0.1 * mean(r.y);
    std::vector<std::uint8_t> bytes(i.y.size(), 128);
    for (std::size_t p = 0; p < bytes.size(); ++p) {
        const double e = (i.y[p] - r.y[p]) / (std::abs(r.y[p]) + floor);
        if (std::isfinite(e))
            bytes[p] = static_cast<std::uint8_t>(
                std::lround(128 + 127 * std::copysign(std::sqrt(std::min(std::abs(e), 1.0)), e)));
    }
    return png_uri(image.width, image.height, 1, bytes);
}

} // namespace keyhole
