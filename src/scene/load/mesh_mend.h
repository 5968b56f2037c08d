// What meshes of other programs need before they can be rendered.
#pragma once

#include "scene/shape.h"

#include <string>

namespace keyhole {

constexpr float kMaxMeshCoordinate = 1e12f; ///< as for coordinates in scene files
constexpr std::size_t kMaxMeshTriangles = std::size_t{1} << 26;

/// Drops triangles without area, normalises normals and replaces those that are none, and sets texture coordinates that
/// are not finite to zero.
/// @param source named in messages.
/// @throws InputError "source: ..." for positions that are not finite or beyond kMaxMeshCoordinate, and indices out of
/// range.
void mend_mesh(TriangleMesh& mesh, const std::string& source);

/// Gives every position the mean of the normals of its triangles, weighted by their angle there (Thuermer and Wuethrich
/// 1998).
void smooth_normals(TriangleMesh& mesh);

} // namespace keyhole
