// Lines on 8-bit pictures.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace keyhole {

using Rgb8 = std::array<std::uint8_t, 3>;

/// A picture of 3 bytes a pixel, first row on top.
struct Canvas {
    int width, height;
    std::vector<std::uint8_t> pixels;
};

/// Blends a disc over the canvas; its edge is a pixel wide. `center` and `radius` in pixels; parts outside are left
/// out.
void draw_disc(Canvas& canvas, const Vec2& center, float radius, const Rgb8& color, float opacity = 1);

/// Bright colour number i, unlike its neighbours.
Rgb8 palette_color(std::size_t i);

} // namespace keyhole
