// Transforms of shapes that leave their outside outside.
#pragma once

#include "scene/shape.h"

#include <Imath/ImathMatrix.h>

namespace keyhole {

/// Row vectors times matrix, as Imath has it: of two transforms the first to act stands on the left.
using Transform = Imath::M44d;
using Geometry = decltype(Shape::geometry);

/// |det| of the linear part over the product of its rows' lengths: 1 for rotations and scalings, 0 when singular.
double regularity(const Transform& t);

/// Moves a mesh to where `t` (regular) takes it. A mirrored transform reverses the corners of the triangles.
void transform_mesh(TriangleMesh& mesh, const Transform& t);

/// As transform_mesh(). A sphere stays one where `t` scales all directions alike, else it becomes a mesh with normals.
void transform_geometry(Geometry& geometry, const Transform& t);

/// Whether no coordinate is beyond 1e13, a margin around what files may say: cubes of lengths stay within a float.
bool has_bounded_positions(const Geometry& geometry);

/// Exchanges outside and inside.
void flip(Geometry& geometry);

} // namespace keyhole
