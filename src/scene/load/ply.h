// Triangle meshes from PLY files (Turk 1994), in one pass over their bytes.
#pragma once

#include "scene/shape.h"

#include <string>

namespace keyhole {

/// Reads the mesh of a PLY file, text or binary of either byte order, packed with gzip or not: positions `x y z`;
/// normals `nx ny nz`; texture coordinates `u v`, `s t`, `texture_u texture_v` or `texture_s texture_t`; faces
/// `vertex_indices` or `vertex_index`, of which those with more than three corners become fans. Everything else in the
/// file is passed over. The mesh is mended as mend_mesh() does, which leaves no triangles where none has an area.
/// @throws InputError "path: ..." for a missing, broken or truncated file, and for what mend_mesh() refuses.
TriangleMesh read_ply(const std::string& path);

} // namespace keyhole
