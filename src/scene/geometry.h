// Points on shapes.
#pragma once

#include "scene/shape.h"
#include "scene/surface_point.h"

namespace keyhole {

/// The point with barycentric coordinates (1-u-v, u, v) on a triangle. Fills in everything but shape and emitter; the
/// parametrisation (texture coordinates, tangent and derivatives) if it is asked for.
SurfacePoint triangle_point(const TriangleMesh& mesh, std::uint32_t triangle, float u, float v,
                            bool parametrised = true);

/// Bound on the error along unit `n` of a position [m] that rounding alone makes, in what was interpolated and in the
/// next intersection.
float rounding_along(const Vec3& n, const Vec3& p);

/// The point of a sphere in direction `outward` (unit) from its centre.
SurfacePoint sphere_point(const Sphere& sphere, const Vec3& outward, bool parametrised = true);

/// Area of a triangle [m^2].
double triangle_area(const TriangleMesh& mesh, std::uint32_t triangle);

/// Whether a triangle is more than a line or a point. Others have no normal; nothing may hit or sample them.
bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle);

/// Whether any part of a shape has an area in that sense.
bool has_area(const std::variant<TriangleMesh, Sphere>& geometry);

/// Area of a shape [m^2].
double surface_area(const Shape& shape);

/// Memory that its positions, normals, texture coordinates and indices take.
std::size_t geometry_bytes(const Shape& shape);

} // namespace keyhole
