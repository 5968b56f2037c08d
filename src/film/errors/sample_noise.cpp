#include "film/errors/sample_noise.h"

#include "film/grey.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace keyhole {

std::optional<double> sample_noise(const Picture& picture) {
    const Image& beauty = picture.layers.at("beauty");
    Image noise(beauty.width, beauty.height, 3);
    for (const char* name : {"direct", "indirect", "caustic"}) {
        const auto layer = picture.layers.find(name), of_layer = picture.layers.find(noise_layer(name));
        if (layer == picture.layers.end() || of_layer == picture.layers.end()) return std::nullopt;
        const auto is_black = [](const Image& image) {
            return std::ranges::all_of(image.data, [](float v) { return v == 0; });
        };
        if (is_black(of_layer->second) && !is_black(layer->second)) return std::nullopt;
        std::ranges::transform(noise.data, of_layer->second.data, noise.data.begin(), std::plus());
    }
    const Grey light(beauty), difference(noise);
    const std::vector<double> smoothed = smooth(light);
    const double mean_light = mean(light.y);
    std::vector<double> squares;
    for (std::size_t i = 0; i < light.y.size(); ++i)
        if (difference.y[i] != 0 || light.y[i] == 0) // known
            squares.push_back(difference.y[i] * difference.y[i] / error_unit(smoothed[i], mean_light));
    const double noise_of_all = std::sqrt(trimmed_mean(squares));
    return std::isfinite(noise_of_all) ? std::optional(noise_of_all) : std::nullopt;
}

} // namespace keyhole
