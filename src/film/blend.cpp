#include "film/blend.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

void blend(Picture& picture, const Picture& other, double weight) {
    for (auto& [name, image] : picture.layers) {
        const auto layer = other.layers.find(name);
        if (layer == other.layers.end() || layer->second.data.size() != image.data.size())
            throw InputError("found no layer '" + name + "'");
        std::ranges::transform(image.data, layer->second.data, image.data.begin(), [&](float a, float b) {
            return static_cast<float>(std::lerp(static_cast<double>(a), static_cast<double>(b), weight));
        });
    }
}

} // namespace keyhole
