#include "film/drawn_light.h"

#include "film/pixel_words.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace keyhole {

DrawnLight::DrawnLight(int width, int height)
    : pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

void DrawnLight::add(const SplatFilm& unit, double scale) {
    assert(unit.pixels() == pixels_.size());
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        const auto sums = unit.sums(p);
        for (std::size_t c = 0; c < sums.size(); ++c) pixels_[p].sums.add(c, scale * sums[c]);
        ++pixels_[p].units;
    }
}

void DrawnLight::merge(const DrawnLight& other) {
    assert(other.pixels_.size() == pixels_.size());
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        pixels_[p].sums.merge(other.pixels_[p].sums);
        pixels_[p].units += other.pixels_[p].units;
    }
}

void DrawnLight::clear() { std::ranges::fill(pixels_, Pixel{}); }

PixelWords DrawnLight::words() const { return pixel_words(pixels_); }

void DrawnLight::set_words(const PixelWords& words) { set_pixels(pixels_, words); }

DrawnLight::Means DrawnLight::means(const Pixel& pixel) {
    Means mean{};
    if (pixel.units == 0) return mean;
    for (std::size_t c = 0; c < mean.size(); ++c) mean[c] = pixel.sums.value(c) / static_cast<double>(pixel.units);
    return mean;
}

double DrawnLight::mean_luminance(std::size_t pixel) const {
    const Means m = means(pixels_[pixel]);
    return luminance(Rgb(m[0] + m[3] + m[6], m[1] + m[4] + m[7], m[2] + m[5] + m[8]));
}

void DrawnLight::add_to(Picture& picture) const {
    Image& beauty = picture.layers.at("beauty");
    const std::array<Image*, 3> layers{&picture.layers.at("direct"), &picture.layers.at("indirect"),
                                       &picture.layers.at("caustic")};
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        const Means mean = means(pixels_[p]);
        for (std::size_t c = 0; c < mean.size(); ++c) {
            const auto value = static_cast<float>(mean[c]);
            layers[c / 3]->data[p * 3 + c % 3] += value;
            beauty.data[p * 3 + c % 3] += value;
        }
    }
}

} // namespace keyhole
