// Layers of a picture that are filtered as one.
#pragma once

#include "core/vec.h"
#include "film/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace keyhole {

inline float luminance_at(const Image& image, int x, int y) {
    const float* p = image.at(x, y);
    return static_cast<float>(luminance(Rgb(p[0], p[1], p[2])));
}

/// Multiplies by a power of two.
inline void scale(Image& image, int exponent) {
    for (float& v : image.data) v = std::ldexp(v, exponent);
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

    /// Brings its mean near 1, so that squares are numbers, whatever the unit of light. Returns the exponent of the
    /// power of two that it was.
    int normalise() {
        double sum = 0;
        for (const float v : mean.data) sum += std::abs(double{v});
        int exponent = 0;
        std::frexp(sum / static_cast<double>(mean.data.size()), &exponent);
        scale(mean, -exponent);
        scale(noise, -exponent);
        return exponent;
    }

  private:
    static void add(const Image& layer, Image& sum) {
        std::ranges::transform(layer.data, sum.data, sum.data.begin(), std::plus());
    }
};

/// A pixel that a filter would make larger instead of less noisy.
struct Outlier {
    int x, y;
    std::array<float, 3> mean; ///< that it had
    bool confirmed;            ///< both halves of the samples have it
};

/// Finds pixels so bright that each, spread over those within `reach`, would make a disc of half their brightness more:
/// a lamp smaller than a pixel, or a sample out of thousands. Puts the mean of the others into their place, without
/// noise.
std::vector<Outlier> take_out_outliers(FilterPart& part, int reach);

} // namespace keyhole
