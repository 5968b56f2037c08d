// Pictures: named layers of pixels with metadata.
#pragma once

#include "core/bytes.h"
#include "core/error.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace keyhole {

/// Row-major pixels, `channels` floats each, first row on top.
struct Image {
    int width = 0, height = 0, channels = 3;
    std::vector<float> data;

    Image() = default;
    Image(int w, int h, int c)
        : width(w), height(h), channels(c),
          data(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c), 0.0f) {}

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    float* at(int x, int y) { return data.data() + index(x, y); }
    const float* at(int x, int y) const { return data.data() + index(x, y); }

  private:
    std::size_t index(int x, int y) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels);
    }
};

/// What stands in memory for the pixels of a film: `words` words each, first row on top.
struct AccumulatorState {
    int words = 0;
    std::vector<std::uint32_t> data;

    auto parts() { return std::tie(words, data); }
};

template <class Pixel> AccumulatorState accumulator_state(const std::vector<Pixel>& pixels) {
    static_assert(std::is_trivially_copyable_v<Pixel> && sizeof(Pixel) % sizeof(std::uint32_t) == 0);
    constexpr std::size_t kWords = sizeof(Pixel) / sizeof(std::uint32_t);
    AccumulatorState state{static_cast<int>(kWords), std::vector<std::uint32_t>(pixels.size() * kWords)};
    std::ranges::copy(bytes_of(pixels.data(), pixels.size()), bytes_of(state.data.data(), state.data.size()).begin());
    return state;
}

/// @throws InputError if the state is not that of as many pixels of this kind.
template <class Pixel> void set_pixels(std::vector<Pixel>& pixels, const AccumulatorState& state) {
    const auto from = bytes_of(state.data.data(), state.data.size());
    if (from.size() != pixels.size() * sizeof(Pixel))
        throw InputError("found sums of another film than this picture's");
    std::ranges::copy(from, bytes_of(pixels.data(), pixels.size()).begin());
}

/// The layer that holds half the difference between two halves of the samples of layer `name`: its noise.
inline std::string noise_layer(const std::string& name) { return "noise." + name; }

/// What a render makes. The layer "beauty" is what is looked at: linear Rec. 709, W/(m^2 sr).
struct Picture {
    int width = 0, height = 0;
    std::map<std::string, Image> layers;
    std::map<std::string, std::string> metadata;
    /// Of a picture that others are to be joined with: the sums that its layers are means of, by kind; see
    /// AccumulationBuffer.
    std::map<std::string, AccumulatorState> sums;
};

/// Takes these layers out of a picture.
inline std::map<std::string, Image> take_noise_layers(Picture& picture) {
    std::map<std::string, Image> noise;
    for (auto at = picture.layers.begin(); at != picture.layers.end();) {
        const auto layer = at++;
        if (layer->first.starts_with(noise_layer({}))) noise.insert(picture.layers.extract(layer));
    }
    return noise;
}
inline void erase_noise_layers(Picture& picture) { take_noise_layers(picture); }

} // namespace keyhole
