// Spheres, disks and cylinders of pbrt's format, in their own space.
#pragma once

#include "scene/load/geometry_transform.h"
#include "scene/pbrt/parameters.h"

namespace keyhole::pbrt {

/// `radius`, `zmin`, `zmax`, `phimax`. A part of a sphere becomes a mesh. @throws InputError for impossible values.
Geometry read_sphere(Parameters& parameters);
/// A whole sphere as a mesh that has pbrt's texture coordinates: u along longitude from +x, v from -z to +z.
TriangleMesh parametrised_sphere(double radius);
/// `height`, `radius`, `innerradius`, `phimax`; its outside is +z. @throws InputError for impossible values.
Geometry read_disk(Parameters& parameters);
/// `radius`, `zmin`, `zmax`, `phimax`, along z. @throws InputError for impossible values.
Geometry read_cylinder(Parameters& parameters);

} // namespace keyhole::pbrt
