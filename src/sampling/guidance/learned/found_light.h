// What shadow rays that count in no picture have found.
#pragma once

#include "sampling/guidance/learned/surface_cells.h"

#include <cstdint>

namespace keyhole {

/// Light that a shadow ray found: a sample of an emitter's point that is seen from a place.
struct FoundLight {
    SurfaceCells::Place at;
    std::uint32_t emitter;
    bool infinite;    ///< from an environment
    Vec3 towards;     ///< unit: where it came from
    double value;     ///< luminance that it would bring per unit of the coordinates of the emitter's point [W/m^2 / ..]
    double choice;    ///< probability of the emitter by the light tree
    double point_pdf; ///< of the point by the emitter
    double density{0}; ///< of all samples that were drawn in search of light, added up: balance heuristic
};

} // namespace keyhole
