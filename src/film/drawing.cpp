#include "film/drawing.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

void draw_disc(Canvas& canvas, const Vec2& center, float radius, const Rgb8& color, float opacity) {
    const int x0 = std::max(0, static_cast<int>(std::floor(center.x - radius - 1))),
              x1 = std::min(canvas.width - 1, static_cast<int>(std::ceil(center.x + radius + 1))),
              y0 = std::max(0, static_cast<int>(std::floor(center.y - radius - 1))),
              y1 = std::min(canvas.height - 1, static_cast<int>(std::ceil(center.y + radius + 1)));
    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            const float r =
                std::hypot(static_cast<float>(x) + 0.5f - center.x, static_cast<float>(y) + 0.5f - center.y);
            const float a = opacity * std::clamp(radius + 0.5f - r, 0.0f, 1.0f);
            const auto first = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas.width) +
                                    static_cast<std::size_t>(x));
            for (std::size_t c = 0; c < 3; ++c) {
                std::uint8_t& p = canvas.pixels[first + c];
                p = static_cast<std::uint8_t>(
                    std::lround((1 - a) * static_cast<float>(p) + a * static_cast<float>(color[c])));
            }
        }
    }
}

Rgb8 palette_color(std::size_t i) {
    // Steps of the golden ratio around the circle of hues.
    const double hue = 6 * std::fmod(0.06 + 0.618033988749895 * static_cast<double>(i), 1.0);
    const auto channel = [&](double shift) {
        const double k = std::fmod(hue + shift, 6.0);
        return static_cast<std::uint8_t>(255 * (1 - 0.85 * std::clamp(std::min(k, 4 - k), 0.0, 1.0)));
    };
    return {channel(5), channel(3), channel(1)};
}

} // namespace keyhole
