#include "film/errors/sample_noise.h"

#include "film/errors/image_error.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace keyhole {

std::optional<double> sample_noise(const Picture& picture) {
    const Image& beauty = picture.layers.at("beauty");
    Image half = beauty;
    for (const char* name : {"direct", "indirect", "caustic"}) {
        const auto layer = picture.layers.find(name), noise = picture.layers.find(noise_layer(name));
        if (layer == picture.layers.end() || noise == picture.layers.end()) return std::nullopt;
        const auto is_black = [](const Image& image) {
            return std::ranges::all_of(image.data, [](float v) { return v == 0; });
        };
        if (is_black(noise->second) && !is_black(layer->second)) return std::nullopt;
        std::ranges::transform(half.data, noise->second.data, half.data.begin(), std::plus());
    }
    return std::sqrt(image_error(half, beauty, &beauty).cross_trim.value_or(0));
}

} // namespace keyhole
