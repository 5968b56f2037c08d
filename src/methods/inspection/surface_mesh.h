// A scene's surfaces as one mesh of coloured triangles that a browser can hold.
#pragma once

#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace keyhole {

struct SurfaceMesh {
    using Triangle = std::array<std::uint32_t, 3>;

    std::vector<Vec3> positions;
    std::vector<std::array<std::uint8_t, 3>> colours; ///< of positions: what the surface reflects, sRGB
    std::vector<Triangle> triangles;     ///< opaque ones, then emitters, then those that light goes through
    std::size_t emitters = 0, clear = 0; ///< where the latter two begin
    std::size_t of_scene = 0;            ///< triangles that the scene has
};

/// Shapes that have too many triangles for their share of `most` are simplified: corners in the same cell of a grid
/// become one (Rossignac and Borrel 1993). Emitters stay as they are as long as they have few.
SurfaceMesh surface_mesh(const Scene& scene, std::size_t most);

} // namespace keyhole
