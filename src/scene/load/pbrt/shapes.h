// Shapes of pbrt's format, in their own space.
#pragma once

#include "scene/load/load_mesh.h"
#include "scene/load/pbrt/curves.h"
#include "scene/load/pbrt/syntax/parameters.h"

#include <string>

namespace keyhole::pbrt {

/// What a `Shape` directive describes.
struct ShapeSource {
    Geometry geometry;               ///< unless a file has it
    std::string ply_path;            ///< of a `plymesh`, not yet read
    std::size_t faces_per_patch = 1; ///< triangles that pbrt counts as one shape: 2 for bilinear patches
    CurveSet curves{};               ///< not yet a mesh; those of several directives where they look alike
};

/// Reads the geometry of a shape: `trianglemesh`, `plymesh`, `bilinearmesh`, `loopsubdiv` (its control mesh), `sphere`,
/// `disk`, `cylinder` or `curve`. Quadrics that are not whole spheres become meshes.
/// @throws InputError for other shapes and for geometry that makes no sense.
ShapeSource read_shape(Parameters& parameters);

// Quadrics: `radius`; `zmin` and `zmax`, or `height` and `innerradius`; `phimax`.

/// A part of a sphere becomes a mesh. @throws InputError for impossible values, as the next ones do.
Geometry read_sphere(Parameters& parameters);
/// Its outside is +z.
Geometry read_disk(Parameters& parameters);
/// Along z.
Geometry read_cylinder(Parameters& parameters);
/// A whole sphere as a mesh that has pbrt's texture coordinates: u along longitude from +x, v from -z to +z.
TriangleMesh parametrised_sphere(double radius);

/// Points the outside of each triangle to the side that its normals are on, as pbrt does.
void turn_triangles_to_normals(TriangleMesh& mesh);

/// Gives every triangle its own three corners, with the texture coordinates (0,0), (1,0) and (1,1) that pbrt assumes
/// for meshes without any.
void assume_uvs(TriangleMesh& mesh);

} // namespace keyhole::pbrt
