// What trials of samplers measure by: parts of a scene, and rays.
#pragma once

#include "scene/scene.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace keyhole {

constexpr int kCellsOfTrial = 4; ///< along each axis
constexpr std::size_t kPartsOfTrial = std::size_t{kCellsOfTrial} * kCellsOfTrial * kCellsOfTrial;
using Shares = std::array<double, kPartsOfTrial>;

/// The part that a point lies in: equal cells of the scene's bounding box.
inline std::size_t part_of_scene(const Scene& scene, const Vec3& p) {
    std::size_t index = 0;
    for (int k = 0; k < 3; ++k) {
        const float extent = scene.upper()[k] - scene.lower()[k];
        const float x = extent > 0 ? (p[k] - scene.lower()[k]) / extent : 0.0f;
        const int cell = std::clamp(static_cast<int>(x * kCellsOfTrial), 0, kCellsOfTrial - 1);
        index = index * kCellsOfTrial + static_cast<std::size_t>(cell);
    }
    return index;
}

/// What a mutation does besides tracing rays, measuring paths in the main, costs as much as several rays of light
/// tracing.
constexpr double kMutationRay = 3;

} // namespace keyhole
