// The area that a disc and a triangle have in common.
#pragma once

#include <Imath/ImathVec.h>

namespace keyhole {

/// Area of the part of the disc of radius `r` about the origin that lies in triangle abc, exact up to rounding. Either
/// orientation of the triangle.
double disc_triangle_area(const Imath::V2d& a, const Imath::V2d& b, const Imath::V2d& c, double r);

} // namespace keyhole
