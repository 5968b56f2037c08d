// How pictures of all directions are laid out.
#pragma once

#include "core/vec.h"

#include <Imath/ImathMatrix.h>

namespace keyhole {

enum class SphereLayout {
    lat_long,   ///< rows from the zenith, +y, to the nadir; the middle looks along -z, and right of it is +x
    octahedral, ///< equal areas for equal solid angles (Clarberg 2008); the middle is +z, the corners are -z
};

/// Picture coordinates are in [0,1]^2, (0,0) the corner of the first pixel of the first row.
using Vec2d = Imath::V2d;

/// The unit direction at a place of the picture.
Vec3 sphere_direction(SphereLayout layout, const Vec2d& place);

/// The place of a unit direction.
Vec2d sphere_place(SphereLayout layout, const Vec3& w);

/// Whether `m` turns a picture and no more; it may mirror it.
inline bool is_rotation(const Imath::M33d& m) { return (m * m.transposed()).equalWithAbsError(Imath::M33d(), 1e-4); }

} // namespace keyhole
