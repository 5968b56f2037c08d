// Points on shapes.
#pragma once

#include "scene/shape.h"
#include "scene/surface_point.h"

#include <set>
#include <vector>

namespace keyhole {

/// The point with barycentric coordinates (1-u-v, u, v) on a triangle. Fills in everything but shape and emitter; the
/// parametrisation (texture coordinates, tangent and derivatives) if it is asked for.
SurfacePoint triangle_point(const TriangleMesh& mesh, std::uint32_t triangle, float u, float v,
                            bool parametrised = true);

/// The mesh of a shape: of an instance that in the space of its object. Null: a sphere.
const TriangleMesh* held_mesh(const Shape& shape);

/// The meshes of shapes, each once however many instances it has.
std::set<const TriangleMesh*> held_meshes(const std::vector<Shape>& shapes);

/// Memory that meshes, each once, and spheres take.
std::size_t geometry_bytes(const std::vector<Shape>& shapes);

/// Triangles; a sphere has none.
std::size_t triangle_count(const Shape& shape);

// Triangles of a shape that has some, as they stand in the world.

std::array<Vec3, 3> triangle_corners(const Shape& shape, std::uint32_t triangle);
/// As of a mesh, in world space. The offset of a point of an instance covers the rounding of its transform.
SurfacePoint triangle_point(const Shape& shape, std::uint32_t triangle, float u, float v, bool parametrised = true);
/// Area of a triangle [m^2].
double triangle_area(const Shape& shape, std::uint32_t triangle);

/// Bound on the error along unit `n` of a position [m] that rounding alone makes, in what was interpolated and in the
/// next intersection.
float rounding_along(const Vec3& n, const Vec3& p);

/// The point of a sphere in direction `outward` (unit) from its centre.
SurfacePoint sphere_point(const Sphere& sphere, const Vec3& outward, bool parametrised = true);

/// Area of a triangle [m^2].
double triangle_area(const TriangleMesh& mesh, std::uint32_t triangle);

/// Whether a triangle is more than a line or a point where all is `scale` times as large. Others have no normal;
/// nothing may hit or sample them.
bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle, double scale = 1);

/// Whether any part of a shape has an area in that sense. An instance has where its mesh has triangles: what they are
/// as large as is said where they stand.
bool has_area(const Geometry& geometry);

/// Area of a shape [m^2].
double surface_area(const Shape& shape);

/// The triangles of an instance in world space, not marked as flat: some may yet be dropped there.
TriangleMesh flattened(const MeshInstance& instance);

/// Exchanges the sides of all triangles.
void reverse_winding(TriangleMesh& mesh);

/// Whether a triangle, at least, is flat or would be marked as that.
bool is_flat_in_part(const TriangleMesh& mesh);

/// Moves a mesh to where a transform takes it. A mirrored one reverses the corners of the triangles.
void transform_mesh(TriangleMesh& mesh, const ObjectToWorld& to_world);

} // namespace keyhole
