// The pixels of a film as words, to be written to a file and read again.
#pragma once

#include "core/error.h"
#include "film/picture.h"

#include <cstring>
#include <type_traits>

namespace keyhole {

template <class Pixel> PixelWords pixel_words(const std::vector<Pixel>& pixels) {
    static_assert(std::is_trivially_copyable_v<Pixel> && sizeof(Pixel) % sizeof(std::uint32_t) == 0);
    constexpr std::size_t kWords = sizeof(Pixel) / sizeof(std::uint32_t);
    PixelWords words{static_cast<int>(kWords), std::vector<std::uint32_t>(pixels.size() * kWords)};
    if (!pixels.empty()) std::memcpy(words.data.data(), pixels.data(), pixels.size() * sizeof(Pixel));
    return words;
}

/// @throws InputError if the words are not those of as many pixels of this kind.
template <class Pixel> void set_pixels(std::vector<Pixel>& pixels, const PixelWords& words) {
    const std::size_t bytes = words.data.size() * sizeof(std::uint32_t);
    if (bytes != pixels.size() * sizeof(Pixel)) throw InputError("found sums of another film than this picture's");
    if (bytes > 0) std::memcpy(static_cast<void*>(pixels.data()), words.data.data(), bytes);
}

} // namespace keyhole
