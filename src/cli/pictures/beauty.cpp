#include "cli/pictures/beauty.h"

#include "core/error.h"
#include "film/files/exr.h"

#include <algorithm>

namespace keyhole {

Image read_beauty(const std::string& path) {
    Picture picture = read_exr(path);
    const auto layer = picture.layers.find("beauty");
    if (layer == picture.layers.end()) throw InputError(path + ": found no channels R, G, B or Y");
    return std::move(layer->second);
}

Image mean_of(Image a, const Image& b) {
    std::ranges::transform(a.data, b.data, a.data.begin(), [](float x, float y) { return (x + y) / 2; });
    return a;
}

} // namespace keyhole
