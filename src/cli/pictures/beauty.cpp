#include "cli/pictures/beauty.h"

#include "core/error.h"
#include "film/files/exr.h"

namespace keyhole {

Image read_beauty(const std::string& path) {
    Picture picture = read_exr(path);
    const auto layer = picture.layers.find("beauty");
    if (layer == picture.layers.end()) throw InputError(path + ": found no channels R, G, B or Y");
    return std::move(layer->second);
}

} // namespace keyhole
