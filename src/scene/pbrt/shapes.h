// Shapes of pbrt's format, in their own space.
#pragma once

#include "scene/load/geometry_transform.h"
#include "scene/pbrt/parameters.h"

#include <string>

namespace keyhole::pbrt {

/// What a `Shape` directive describes.
struct ShapeSource {
    Geometry geometry;               ///< unless a file has it
    std::string ply_path;            ///< of a `plymesh`, not yet read
    std::size_t faces_per_patch = 1; ///< triangles that pbrt counts as one shape: 2 for bilinear patches
};

/// Reads the geometry of a shape: `trianglemesh`, `plymesh`, `bilinearmesh`, `loopsubdiv` (its control mesh), `sphere`,
/// `disk` or `cylinder`. Quadrics that are not whole spheres become meshes.
/// @throws InputError for other shapes and for geometry that makes no sense.
ShapeSource read_shape(Parameters& parameters);

/// Points the outside of each triangle to the side that its normals are on, as pbrt does.
void turn_triangles_to_normals(TriangleMesh& mesh);

/// Gives every triangle its own three corners, with the texture coordinates (0,0), (1,0) and (1,1) that pbrt assumes
/// for meshes without any.
void assume_uvs(TriangleMesh& mesh);

} // namespace keyhole::pbrt
