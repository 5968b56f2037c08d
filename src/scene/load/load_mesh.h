// Triangle meshes from files and of simple shapes, and what moves them.
#pragma once

#include "scene/shape.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <memory>
#include <string>
#include <vector>

namespace keyhole {

/// Row vectors times matrix, as Imath has it: of two transforms the first to act stands on the left.
using Transform = Imath::M44d;

/// More are refused.
constexpr std::size_t kMaxMeshTriangles = std::size_t{1} << 26;
/// As for coordinates in scene files: cubes of lengths must stay within a float.
constexpr float kMaxMeshCoordinate = 1e12f;
/// Limits on what groups of groups, or instances, may multiply to.
constexpr std::size_t kMaxShapes = std::size_t{1} << 20;
constexpr std::size_t kMaxTriangles = std::size_t{1} << 27;

// Files: mesh/import.cpp and mesh/ply.cpp.

/// Reads all triangles of an OBJ, PLY (packed with gzip or not), glTF or GLB file as one mesh, with the placements that
/// the file gives its parts. Materials, cameras, lights, lines and points in the file are left out; so is what
/// a placement flattens, which hides it in glTF, and triangles without area, of which a mesh may consist. Normals are
/// those of the file, unit; if only some of its parts have normals, the others get smooth ones.
/// @throws InputError "path: ..." for a missing, unknown, broken or empty file, positions that are not finite or beyond
/// 1e12, indices out of range, and more than kMaxMeshTriangles triangles.
TriangleMesh import_mesh(const std::string& path);

/// A part of a file where that places it.
struct MeshPart {
    Geometry geometry;              ///< a mesh, or one of several instances of it
    std::vector<Imath::V4f> colors; ///< red, green, blue and opacity, linear; one per position of a mesh that is no
                                    ///< instance, or empty
    std::string material;           ///< its name; may be empty
    std::string name;               ///< of the node that places it; may be empty
};

/// Reads the parts of an OBJ, glTF or GLB file one by one, as import_mesh() does.
/// @param content of the file, which is not read then, but for those that it refers to; null: read it.
/// @throws InputError as import_mesh().
std::vector<MeshPart> import_parts(const std::string& path, const std::string* content = nullptr);

/// Reads the mesh of a PLY file (Turk 1994) in one pass over its bytes, text or binary of either byte order, packed
/// with gzip or not: positions `x y z`; normals `nx ny nz`; texture coordinates `u v`, `s t`, `texture_u texture_v` or
/// `texture_s texture_t`; faces `vertex_indices` or `vertex_index`, of which those with more than three corners become
/// fans. Everything else in the file is passed over. The mesh is mended as mend_mesh() does, which leaves no triangles
/// where none has an area.
/// @throws InputError "path: ..." for a missing, broken or truncated file, and for what mend_mesh() refuses.
TriangleMesh read_ply(const std::string& path);

/// Drops triangles without area, normalises normals and replaces those that are none, and sets texture coordinates that
/// are not finite to zero.
/// @param source named in messages.
/// @throws InputError "source: ..." for positions that are not finite or beyond kMaxMeshCoordinate, and indices out of
/// range.
void mend_mesh(TriangleMesh& mesh, const std::string& source);

/// Gives every position the mean of the normals of its triangles, weighted by their angle there (Thuermer and Wuethrich
/// 1998).
void smooth_normals(TriangleMesh& mesh);

// What meshes enclose: mesh/closed.cpp.

/// Holds all positions, used or not [m].
Imath::Box3d box_of(const TriangleMesh& mesh);

/// Whether a mesh encloses a volume: between any two places as many edges of triangles run one way as the other. Gaps
/// as narrow as rounding makes them at seams don't count.
bool is_closed(const TriangleMesh& mesh);

// Simple shapes: mesh/primitives.cpp.

/// The parallelogram corner + [0,1] u + [0,1] v. Its outside is that of u x v; texture coordinates run along u and v.
TriangleMesh make_parallelogram(const Vec3& corner, const Vec3& u, const Vec3& v);

/// The box between two opposite corners, outside outward, with texture coordinates for each face.
TriangleMesh make_box(const Vec3& minimum, const Vec3& maximum);

/// A sphere as 256 x 128 facets along longitude and latitude, with its exact normals, outside outward. The facets lie
/// within 1e-4 radii of the sphere.
TriangleMesh tessellate(const Sphere& sphere);

/// Adds the triangles of a grid of (columns + 1) x (rows + 1) positions, row by row from `first`; they turn from along
/// a row to the next row.
void append_grid(TriangleMesh& mesh, std::uint32_t first, std::uint32_t columns, std::uint32_t rows);

// Transforms that leave the outside outside: mesh/transform.cpp.

/// |det| of the linear part over the product of its rows' lengths: 1 for rotations and scalings, 0 when singular.
double regularity(const Transform& t);
/// Whether what it moves keeps its dimensions, but for rounding.
inline bool is_regular(const Transform& t) { return regularity(t) > 1e-12; }

/// Moves it to where `t` (regular) takes it. A sphere stays one where `t` scales all directions alike, else it becomes
/// a mesh with normals.
void transform_geometry(Geometry& geometry, const Transform& t);

/// Whether no coordinate is beyond 1e13, a margin around what files may say: cubes of lengths stay within a float. Not
/// for instances.
bool has_bounded_positions(const Geometry& geometry);

/// Exchanges outside and inside, of what is no instance.
void flip(Geometry& geometry);

// Meshes that stand in several places: mesh/shared_mesh.cpp.

/// Whether a mesh of that many triangles is better held once for all of its copies than moved to each of their places.
bool is_worth_sharing(std::size_t triangles, std::size_t copies);

/// A mesh for copies of an object.
class SharedMesh {
  public:
    /// `mesh` in the space of the object. Triangles that are lines or points are dropped.
    explicit SharedMesh(TriangleMesh mesh);
    const TriangleMesh& mesh() const { return *mesh_; }
    /// Whether it is an instance in a copy there, which would not be too inexact or too far away.
    bool stands_as_instance(const ObjectToWorld& to_world) const;
    /// The mesh where it stands in a copy: an instance, or moved there.
    Geometry placed(const std::shared_ptr<const ObjectToWorld>& to_world) const;

  private:
    std::shared_ptr<const TriangleMesh> mesh_;
    double largest_ = 0; // coordinate
};

} // namespace keyhole
