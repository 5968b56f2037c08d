// Layers of a picture that are filtered as one.
#pragma once

#include "core/vec.h"
#include "film/picture.h"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <string>

namespace keyhole {

inline float luminance_at(const Image& image, int x, int y) {
    const float* p = image.at(x, y);
    return static_cast<float>(luminance(Rgb(p[0], p[1], p[2])));
}

/// The sum of some layers of three channels, and of their noise.
struct FilterPart {
    Image mean, noise;

    FilterPart(const Picture& picture, std::initializer_list<const char*> layers)
        : mean(picture.width, picture.height, 3), noise(mean) {
        for (const std::string layer : layers) {
            add(picture.layers.at(layer), mean);
            add(picture.layers.at(noise_layer(layer)), noise);
        }
    }

  private:
    static void add(const Image& layer, Image& sum) {
        std::ranges::transform(layer.data, sum.data, sum.data.begin(), std::plus());
    }
};

} // namespace keyhole
