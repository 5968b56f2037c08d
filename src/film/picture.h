// Pictures: named layers of pixels with metadata.
#pragma once

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

    float* at(int x, int y) { return data.data() + index(x, y); }
    const float* at(int x, int y) const { return data.data() + index(x, y); }

  private:
    std::size_t index(int x, int y) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels);
    }
};

/// What stands in memory for the pixels of a film: `words` words each, first row on top.
struct PixelWords {
    int words = 0;
    std::vector<std::uint32_t> data;
};

/// What a render makes. The layer "beauty" is what is looked at: linear Rec. 709, W/(m^2 sr).
struct Picture {
    int width = 0, height = 0;
    std::map<std::string, Image> layers;
    std::map<std::string, std::string> metadata;
    /// Of a picture that others are to be joined with: the sums that its layers are means of, by kind; see Exposure.
    std::map<std::string, PixelWords> sums;
};

} // namespace keyhole
