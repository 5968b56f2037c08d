// Triangle meshes from files of other programs.
#pragma once

#include "scene/shape.h"

#include <string>

namespace keyhole {

/// Reads all triangles of an OBJ, PLY (packed with gzip or not), glTF or GLB file as one mesh, with the placements that
/// the file gives its parts. Materials, cameras, lights, lines and points in the file are left out; so are triangles
/// without area, of which a mesh may consist. Normals are those of the file, unit; if only some of its parts have
/// normals, the others get smooth ones.
/// @throws InputError "path: ..." for a missing, unknown, broken or empty file, positions that are not finite or beyond
/// 1e12, indices out of range, and more than kMaxMeshTriangles triangles.
TriangleMesh import_mesh(const std::string& path);

} // namespace keyhole
