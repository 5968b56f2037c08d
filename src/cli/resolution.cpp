#include "cli/resolution.h"

#include "core/error.h"

#include <fmt/format.h>

#include <charconv>

namespace keyhole {

void set_resolution(ImageWindow& window, const std::string& text) {
    constexpr int kMostSide = 65536, kMostPixels = 1 << 28; // as in scene files
    int width = 0, height = 0;
    const char* const last = text.data() + text.size();
    const auto x = std::from_chars(text.data(), last, width);
    const bool cross = x.ec == std::errc{} && x.ptr != last && *x.ptr == 'x';
    const auto y = cross ? std::from_chars(x.ptr + 1, last, height) : x;
    const auto in_range = [](int side) { return side >= 1 && side <= kMostSide; };
    if (!cross || y.ec != std::errc{} || y.ptr != last || !in_range(width) || !in_range(height) ||
        width > kMostPixels / height)
        throw InputError(
            fmt::format("found --resolution '{}', expected WIDTHxHEIGHT, 1 to 65536 each, at most 2^28 pixels",
                        text.substr(0, 40)));
    window.width = width;
    window.height = height;
}

} // namespace keyhole
