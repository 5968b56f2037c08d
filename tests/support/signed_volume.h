// The volume of a closed mesh.
#pragma once

#include "scene/shape.h"

namespace keyhole::test {

/// Volume that the mesh encloses [m^3]: positive if its faces turn outwards.
inline double signed_volume(const TriangleMesh& mesh) {
    double volume = 0;
    for (const auto& t : mesh.triangles) {
        const Imath::V3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
        volume += a.dot(b.cross(c)) / 6;
    }
    return volume;
}

} // namespace keyhole::test
