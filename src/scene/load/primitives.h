// Meshes of simple shapes.
#pragma once

#include "scene/shape.h"

namespace keyhole {

/// The parallelogram corner + [0,1] u + [0,1] v. Its outside is that of u x v; texture coordinates run along u and v.
TriangleMesh make_parallelogram(const Vec3& corner, const Vec3& u, const Vec3& v);

/// The box between two opposite corners, outside outward, with texture coordinates for each face.
TriangleMesh make_box(const Vec3& minimum, const Vec3& maximum);

/// A sphere as 256 x 128 facets along longitude and latitude, with its exact normals, outside outward. The facets lie
/// within 1e-4 radii of the sphere.
TriangleMesh tessellate(const Sphere& sphere);

} // namespace keyhole
